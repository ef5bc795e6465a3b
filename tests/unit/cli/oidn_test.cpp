// Tests --denoise=oidn, which uses the library OpenImageDenoise, and the file names of --denoise. A
// stand-in (tests/support/oidn) replaces the library. For images that are 13 pixels wide, the
// stand-in fails with the error "an unlucky width". For images of other widths, it computes
// (color + albedo) / 2 + normal / 4.

#include "coordinator/cli/image/oidn.h"

#include <gmock/gmock.h>

#include "coordinator/cli/image/clean.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;

/// Returns an image of two rows in one colour.
Image filled(std::uint32_t width, const Rgb& color) { return {width, 2, {2 * width, color}}; }

TEST(Oidn, FiltersWithAlbedoAndNormals) {
  const auto oidn = Oidn::load(BANDSAW_OIDN);
  ASSERT_TRUE(oidn.ok()) << oidn.status();
  const auto clean =
      oidn->filter(filled(5, {4, 2, 1}), filled(5, {0.5f, 1, 0}), filled(5, {0, 0, 1}));
  ASSERT_TRUE(clean.ok()) << clean.status();
  ASSERT_EQ(clean->pixels.size(), 10u);
  for (const Rgb& pixel : clean->pixels) {
    EXPECT_EQ(pixel, (Rgb{2.25f, 1.5f, 0.75f}));
  }
}

TEST(Oidn, ReportsTheLibrarysErrors) {
  const auto oidn = Oidn::load(BANDSAW_OIDN);
  ASSERT_TRUE(oidn.ok());
  const Image image = filled(13, {1, 1, 1});
  EXPECT_THAT(std::string(oidn->filter(image, image, image).status().message()),
              HasSubstr("an unlucky width"));
}

TEST(Oidn, TheErrorForAMissingLibraryNamesARemedy) {
  const absl::Status missing = Oidn::load("/nowhere/libOpenImageDenoise.so.2").status();
  EXPECT_TRUE(absl::IsUnavailable(missing));
  EXPECT_THAT(std::string(missing.message()), HasSubstr("install it, or use --denoise"));
  // This library exists, but it is not OpenImageDenoise.
  EXPECT_THAT(std::string(Oidn::load("libm.so.6").status().message()),
              HasSubstr("does not have the functions of version 1 or 2"));
}

TEST(Oidn, TheReportSaysThatBitsMayDiffer) {
  const Denoised clean{filled(2, {1, 1, 1}), filled(2, {0, 0, 0}), {}};
  EXPECT_FALSE(clean_report(clean, Denoiser::kOidn, {}).same_bits);
  EXPECT_EQ(clean_report(clean, Denoiser::kOidn, {}).method, "oidn");
  EXPECT_TRUE(clean_report(clean, Denoiser::kRegression, {"a.png", "b.exr"}).same_bits);
  EXPECT_THAT(clean_report(clean, Denoiser::kRegression, {"a.png", "b.exr"}).raw_outputs,
              testing::ElementsAre("a.raw.png"));
}

// For the output q.png, --denoise also writes the image as rendered to q.raw.png. If q.raw.png were
// an output too, the image as rendered and a clean image would have the same file.
TEST(Clean, NoOutputMayBeTheFileOfTheImageAsRendered) {
  const test::TempDir folder;
  const auto check = [&](const std::vector<std::string>& names, Denoiser denoiser) {
    std::vector<std::string> outputs;
    for (const std::string& name : names) {
      outputs.push_back(folder / name);
    }
    return check_image_files("a.textproto", outputs, outputs, denoiser, {"none"}).status();
  };
  for (const char* raw : {"q.raw.png", "./q.raw.png"}) {
    const absl::Status refused = check({"q.png", raw}, Denoiser::kRegression);
    EXPECT_TRUE(absl::IsInvalidArgument(refused)) << refused;
    EXPECT_THAT(std::string(refused.message()), HasSubstr("q.raw.png: --denoise writes"));
  }
  EXPECT_EQ(check({"q.png", "q.raw.png"}, Denoiser::kNone), absl::OkStatus());
  EXPECT_EQ(check({"q.png", "q.raw.pfm"}, Denoiser::kRegression), absl::OkStatus());
  EXPECT_EQ(check({"q.exr", "q.raw.exr"}, Denoiser::kRegression), absl::OkStatus());
}

}  // namespace
}  // namespace bandsaw::coordinator
