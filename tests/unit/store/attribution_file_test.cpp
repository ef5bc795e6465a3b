// The attribution file, which names the worker that rendered each row of an image.

#include "coordinator/store/attribution_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

class AttributionFileTest : public ::testing::Test {
 protected:
  test::TempDir temp_;
  const std::string path_ = temp_ / "attribution";
};

TEST_F(AttributionFileTest, ReadsWhatWasWritten) {
  const std::vector<RowsBy> attribution = {
      {{0, 7}, "anna's \"desk\"\n"}, {{7, 9}, ""}, {{20, 65536}, "bj\u00f6rn"}};
  ASSERT_TRUE(write_attribution(attribution, path_).ok());
  const auto read = read_attribution(path_);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(*read, attribution);
  ASSERT_TRUE(write_attribution({}, path_).ok());
  EXPECT_TRUE(read_attribution(path_)->empty());
}

TEST_F(AttributionFileTest, AMissingFileIsNotFound) {
  EXPECT_TRUE(absl::IsNotFound(read_attribution(path_).status()));
}

// The texts are, in order: an empty file, a file without its second piece, a piece without rows,
// two pieces that overlap, a row beyond the largest image, a field after the last piece, and too
// many pieces.
TEST_F(AttributionFileTest, TheErrorNamesADamagedFile) {
  for (const char* text :
       {"", "pieces 2\nfirst 0\nlast 7\nworker a\n", "pieces 1\nfirst 7\nlast 7\nworker a\n",
        "pieces 2\nfirst 5\nlast 7\nworker a\nfirst 6\nlast 8\nworker b\n",
        "pieces 1\nfirst 0\nlast 65537\nworker a\n", "pieces 0\nmore\n", "pieces 99999999\n"}) {
    std::ofstream(path_) << text;
    const absl::Status status = read_attribution(path_).status();
    EXPECT_TRUE(absl::IsDataLoss(status)) << text << status;
    EXPECT_NE(status.message().find(path_), std::string::npos);
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
