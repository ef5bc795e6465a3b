// The size, seed, integrator and output file of an image, from the command line or from the scene.

#include "coordinator/cli/scene/image_settings.h"

#include <gtest/gtest.h>

#include "coordinator/cli/base/text.h"
#include "coordinator/cli/options/output_names.h"

namespace bandsaw::coordinator {
namespace {

RenderSettings settings_for(std::optional<std::uint32_t> width,
                            std::optional<std::uint32_t> height) {
  PackageInfo scene;
  scene.width = 600;
  scene.height = 400;
  scene.max_depth = 9;
  ImageOptions options;
  options.width = width;
  options.height = height;
  return image_settings(options, scene).value();
}

TEST(ImageSettings, AreThoseOfTheSceneByDefault) {
  EXPECT_EQ(settings_for({}, {}),
            (RenderSettings{.width = 600, .height = 400, .max_depth = 9, .seed = 0}));
}

// The seed of a frame is the given seed plus the number of the frame, modulo 2^64.
TEST(ImageSettings, EachFrameHasASeedOfItsOwnUnlessTheSeedIsFixed) {
  const PackageInfo scene;
  ImageOptions options;
  options.seed = 5;
  EXPECT_EQ(image_settings(options, scene)->seed, 5u);
  options.choices.frame = 7;
  EXPECT_EQ(image_settings(options, scene)->seed, 12u);
  options.choices.frame = -6;
  EXPECT_EQ(image_settings(options, scene)->seed, UINT64_MAX);
  options.fixed_seed = true;
  EXPECT_EQ(image_settings(options, scene)->seed, 5u);
}

TEST(ImageSettings, TheIntegratorIsThatOfTheSceneByDefault) {
  PackageInfo scene;
  scene.integrator = Integrator::kDirect;
  ImageOptions options;
  EXPECT_EQ(image_settings(options, scene)->integrator, Integrator::kDirect);
  options.integrator = Integrator::kDepth;
  EXPECT_EQ(image_settings(options, scene)->integrator, Integrator::kDepth);
}

TEST(ImageSettings, OneSideAloneKeepsTheAspectRatio) {
  EXPECT_EQ(settings_for(64, {}).height, 43u);
  EXPECT_EQ(settings_for({}, 100).width, 150u);
  EXPECT_EQ(settings_for(1, {}).height, 1u);
  EXPECT_EQ(settings_for(300, 300).width, 300u);
}

TEST(ImageSettings, AnImageThatIsTooLargeIsAnError) {
  ImageOptions options;
  options.width = 65536;
  options.height = 65536;
  EXPECT_FALSE(image_settings(options, PackageInfo()).ok());
  PackageInfo tall;
  tall.width = 1;
  tall.height = 65536;
  options.height = {};
  EXPECT_FALSE(image_settings(options, tall).ok());
}

// The test also covers lists of outputs and the suffix of part files. A part file has sums of
// samples and is no picture. Its name ends in .band, in small or capital letters.
TEST(Output, TheDefaultIsTheScenesNameInTheCurrentFolder) {
  EXPECT_EQ(default_output("scenes/cornell.textproto", ".png"), "cornell.png");
  EXPECT_EQ(default_output("helmet.glb", ".png"), "helmet.png");
  EXPECT_EQ(printable_list({"a.png", "b.pfm"}), "a.png, b.pfm");
  EXPECT_TRUE(is_part_name("x.BAND"));
  EXPECT_FALSE(is_part_name("x.band.png"));
}

}  // namespace
}  // namespace bandsaw::coordinator
