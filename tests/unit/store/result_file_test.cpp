// The finished image on disk, and the detection of any damage.

#include "coordinator/store/result_file.h"

#include <gtest/gtest.h>

#include "renderlib/base/file.h"
#include "tests/support/full_disk.h"
#include "tests/support/temp_dir.h"
#include "tests/unit/store/test_files.h"

namespace bandsaw::coordinator {
namespace {

Image sample_image() {
  Image image{.width = 3, .height = 2, .pixels = {}};
  for (int i = 0; i < 6; ++i) {
    const auto v = static_cast<float>(i);
    image.pixels.push_back({v, -v, 1 / (v + 1)});
  }
  return image;
}

class ResultFileTest : public testing::Test {
 protected:
  test::TempDir folder_;
  std::string path_ = folder_ / "result";
};

TEST_F(ResultFileTest, ReadsBackTheSamePixels) {
  const Image image = sample_image();
  ASSERT_TRUE(write_result(image, folder_.path(), path_).ok());
  ASSERT_TRUE(write_result(image, folder_.path(), path_).ok()) << "writing again must succeed";
  const absl::StatusOr<StoredResult> result = read_result(path_);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->image.width, 3u);
  EXPECT_EQ(result->image.height, 2u);
  EXPECT_EQ(result->image.pixels, image.pixels);
  // The image has 6 pixels of 12 bytes.
  const std::string bytes(reinterpret_cast<const char*>(image.pixels.data()), 6 * 12);
  EXPECT_EQ(result->digest, wire::sha256(bytes));
}

TEST_F(ResultFileTest, IsNotFoundWhenItWasNeverWritten) {
  EXPECT_EQ(read_result(path_).status().code(), absl::StatusCode::kNotFound);
}

TEST_F(ResultFileTest, EveryChangedByteAndEveryCutIsDataLoss) {
  ASSERT_TRUE(write_result(sample_image(), folder_.path(), path_).ok());
  const std::string whole = read_all(path_);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 4);
    write_all(path_, changed);
    EXPECT_EQ(read_result(path_).status().code(), absl::StatusCode::kDataLoss) << "byte " << i;
    write_all(path_, whole.substr(0, i));
    EXPECT_EQ(read_result(path_).status().code(), absl::StatusCode::kDataLoss) << "cut " << i;
  }
}

TEST_F(ResultFileTest, AFullDiskLeavesOnlyTheOldResult) {
  ASSERT_TRUE(write_result(sample_image(), folder_.path(), path_).ok());
  const std::string before = read_all(path_);
  {
    const test::FullDisk full(50);
    EXPECT_EQ(write_result(sample_image(), folder_.path(), path_).code(),
              absl::StatusCode::kResourceExhausted);
  }
  EXPECT_EQ(read_all(path_), before);
  EXPECT_FALSE(file_exists(path_ + ".incoming"));
}

}  // namespace
}  // namespace bandsaw::coordinator
