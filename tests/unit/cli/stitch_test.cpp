// `bandsaw stitch`, which combines part files (some rows or some samples of an image) into the
// image. A band is given as {samples, rows}, which are half-open ranges. StitchCoverage is made
// with the number of rows of the image.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "coordinator/cli/image/part_file.h"
#include "coordinator/cli/image/stitch_coverage.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

using testing::HasSubstr;

std::string error_of(const StitchCoverage& coverage) {
  return std::string(coverage.samples().status().message());
}

TEST(StitchCoverage, PartsInAnyOrderMakeAnImageIfTheyHaveEachSampleOnce) {
  StitchCoverage coverage(10);
  ASSERT_TRUE(coverage.add("b", {{0, 64}, {4, 10}}).ok());
  ASSERT_TRUE(coverage.add("a", {{64, 72}, {0, 4}}).ok());
  ASSERT_TRUE(coverage.add("a", {{0, 64}, {0, 4}}).ok());
  ASSERT_TRUE(coverage.add("b", {{64, 72}, {4, 10}}).ok());
  EXPECT_EQ(coverage.samples().value(), 72u);
}

TEST(StitchCoverage, MissingRowsAreAllNamed) {
  StitchCoverage coverage(10);
  ASSERT_TRUE(coverage.add("a", {{0, 16}, {2, 4}}).ok());
  ASSERT_TRUE(coverage.add("b", {{0, 16}, {7, 9}}).ok());
  EXPECT_THAT(error_of(coverage), HasSubstr("rows 0:2, 4:7, 9:10 are in no part"));
}

TEST(StitchCoverage, TheErrorForARowInTwoPartsNamesBothParts) {
  StitchCoverage coverage(10);
  ASSERT_TRUE(coverage.add("top.band", {{0, 16}, {0, 6}}).ok());
  const absl::Status status = coverage.add("bottom.band", {{0, 16}, {5, 10}});
  EXPECT_EQ(status.message(), "row 5 is in both top.band and bottom.band: leave one out");
}

TEST(StitchCoverage, TheErrorForDifferentNumbersOfSamplesNamesBothParts) {
  StitchCoverage coverage(10);
  ASSERT_TRUE(coverage.add("top.band", {{0, 16}, {0, 5}}).ok());
  ASSERT_TRUE(coverage.add("bottom.band", {{0, 32}, {5, 10}}).ok());
  EXPECT_THAT(error_of(coverage), HasSubstr("top.band has 16, bottom.band has 32"));
}

TEST(StitchCoverage, MissingSamplesOfARowAreNamed) {
  StitchCoverage coverage(1);
  ASSERT_TRUE(coverage.add("a", {{16, 32}, {0, 1}}).ok());
  EXPECT_THAT(error_of(coverage), HasSubstr("row 0 lacks the samples 0:16"));
}

BandRecord record() {
  BandRecord out;
  out.package_digest = std::string(64, 'a');
  out.settings = {.width = 3, .height = 2, .max_depth = 4, .seed = 5};
  out.pixels.band = {{0, 16}, {0, 2}};
  out.pixels.width = 3;
  out.pixels.sums.assign(18, 1.5);
  return out;
}

TEST(PartFile, IsReadAsWritten) {
  const test::TempDir folder;
  const Display shown{-1.5, Tone::kFilmic, false};
  ASSERT_TRUE(write_part(folder / "a.band", {record(), record()}, shown).ok());
  int records = 0;
  const auto display = read_part(folder / "a.band", [&](const BandRecord& read) {
    EXPECT_EQ(read.pixels.sums, record().pixels.sums);
    EXPECT_EQ(read.settings, record().settings);
    ++records;
    return absl::OkStatus();
  });
  ASSERT_TRUE(display.ok()) << display.status();
  EXPECT_EQ(*display, shown);
  EXPECT_EQ(records, 2);
}

// The header holds the exposure and the tone of the image. Without a header they have their
// defaults.
TEST(PartFile, MayHaveNoHeader) {
  const test::TempDir folder;
  const auto bytes = encode_band_record(record()).value();
  std::ofstream(folder / "a.band", std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  const auto display =
      read_part(folder / "a.band", [](const BandRecord&) { return absl::OkStatus(); });
  ASSERT_TRUE(display.ok()) << display.status();
  EXPECT_EQ(*display, Display());
}

TEST(PartFile, ADamagedHeaderIsDetected) {
  const test::TempDir folder;
  ASSERT_TRUE(write_part(folder / "a.band", {record()}, {2, Tone::kNone, false}).ok());
  std::fstream file(folder / "a.band", std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(12);  // in the header
  file.put('x');
  file.close();
  const auto ignore = [](const BandRecord&) { return absl::OkStatus(); };
  EXPECT_EQ(read_part(folder / "a.band", ignore).status().code(), absl::StatusCode::kDataLoss);
}

TEST(PartFile, AHeaderAloneIsNotAPart) {
  const test::TempDir folder;
  ASSERT_TRUE(write_part(folder / "a.band", {}, {2, Tone::kNone, false}).ok());
  const auto ignore = [](const BandRecord&) { return absl::OkStatus(); };
  EXPECT_EQ(read_part(folder / "a.band", ignore).status().code(), absl::StatusCode::kDataLoss);
}

TEST(PartFile, ErrorsNameTheFile) {
  const test::TempDir folder;
  const auto ignore = [](const BandRecord&) { return absl::OkStatus(); };
  EXPECT_THAT(std::string(read_part(folder / "none.band", ignore).status().message()),
              HasSubstr("none.band"));
  EXPECT_THAT(std::string(read_part(BANDSAW_SOURCE "/LICENSE", ignore).status().message()),
              HasSubstr("LICENSE"));
  EXPECT_THAT(std::string(read_part(folder.path(), ignore).status().message()),
              HasSubstr(folder.path()));
}

}  // namespace
}  // namespace bandsaw::coordinator
