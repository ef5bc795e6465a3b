// Tests the colours and the size of a video that ffmpeg makes of images.

#include "coordinator/cli/image/video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "coordinator/cli/base/console.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

constexpr char kFfmpeg[] = "/usr/bin/ffmpeg";
constexpr char kFfprobe[] = "/usr/bin/ffprobe";

class Videos : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFfmpeg) || !std::filesystem::exists(kFfprobe)) {
      GTEST_SKIP() << "ffmpeg is not installed";
    }
    outlive_reader();  // ignores SIGPIPE
  }
  const test::TempDir folder_;
};

// BT.709 gives pure red the luma 16 + 219 * 0.2126 = 63, and BT.601 gives pure red the luma 81. So
// the luma of the first and of the last pixel tells the standard. Width and height are odd, so the
// video has one more column and one more row, which are black.
TEST_F(Videos, HaveTheColorsThatTheirTagsState) {
  constexpr std::uint32_t kWidth = 63;
  constexpr std::uint32_t kHeight = 35;
  const Image red{kWidth, kHeight, std::vector<Rgb>(kWidth * kHeight, Rgb{1, 0, 0})};
  for (const char* name : {"a.mp4", "a.mov", "a.mkv", "a.webm"}) {
    const std::string file = folder_ / name;
    ASSERT_TRUE(Video::check(file).ok());
    Video video(file, 24);
    for (int frame = 0; frame < 3; ++frame) {
      ASSERT_EQ(video.add(red, {}), absl::OkStatus());
    }
    ASSERT_EQ(video.finish(), absl::OkStatus());
    const test::Finished tags = test::run(
        {kFfprobe, "-v", "error", "-show_entries",
         "stream=color_range,color_space,color_transfer,color_primaries", "-of", "csv=p=0", file});
    EXPECT_EQ(tags.out, "tv,bt709,bt709,bt709\n") << name << tags.err;
    const test::Finished frame = test::run({kFfmpeg, "-v", "error", "-i", file, "-frames:v", "1",
                                            "-f", "rawvideo", "-pix_fmt", "yuv420p", "-"});
    // A frame has a byte of luma for each pixel, then two planes of colours with a byte for every
    // four pixels.
    ASSERT_EQ(frame.out.size(), 64u * 36 * 3 / 2) << name << frame.err;
    for (const std::size_t at : {std::size_t{0}, std::size_t{34 * 64 + 62}}) {
      EXPECT_NEAR(static_cast<unsigned char>(frame.out[at]), 63, 4) << name << " pixel " << at;
    }
  }
  // No partial file is left.
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    EXPECT_EQ(entry.path().filename().string().find(".part"), std::string::npos) << entry.path();
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
