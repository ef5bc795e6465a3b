// Lists of frames as people write them, such as "1-10,20".

#include "coordinator/scheduler/api/frame_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<FrameNumber> parsed(const std::string& text) {
  const auto frames = parse_frames(text);
  EXPECT_TRUE(frames.ok()) << frames.status();
  return frames.value_or(std::vector<FrameNumber>{});
}

// A range may have a step: "1:10:3" and "1-9x3" have every third frame.
TEST(FrameNumbers, AreReadAsPeopleWriteThem) {
  EXPECT_THAT(parsed("7"), ElementsAre(7));
  EXPECT_THAT(parsed("1-4"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(parsed("1:4"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(parsed("1:10:3"), ElementsAre(1, 4, 7, 10));
  EXPECT_THAT(parsed("1-9x3"), ElementsAre(1, 4, 7));
  EXPECT_THAT(parsed("47, 60-62"), ElementsAre(47, 60, 61, 62));
  EXPECT_THAT(parsed("5,1-3,2"), ElementsAre(1, 2, 3, 5));
  EXPECT_THAT(parsed("-3:1:2"), ElementsAre(-3, -1, 1));
  EXPECT_THAT(parsed("-5--3"), ElementsAre(-5, -4, -3));
  EXPECT_THAT(parsed("0007"), ElementsAre(7));
}

TEST(FrameNumbers, WrongNumbersAreNamed) {
  const auto wrong = [](const std::string& text) {
    const auto frames = parse_frames(text);
    EXPECT_EQ(frames.status().code(), absl::StatusCode::kInvalidArgument) << text;
    return std::string(frames.status().message());
  };
  EXPECT_THAT(wrong(""), HasSubstr("'' is neither a frame nor a range"));
  EXPECT_THAT(wrong("1,,2"), HasSubstr("neither"));
  EXPECT_THAT(wrong("1-"), HasSubstr("'1-' is neither"));
  EXPECT_THAT(wrong("1:2:"), HasSubstr("neither"));
  EXPECT_THAT(wrong("one"), HasSubstr("'one' is neither"));
  EXPECT_THAT(wrong("1.5"), HasSubstr("neither"));
  EXPECT_THAT(wrong("1:5:2:7"), HasSubstr("neither"));
  EXPECT_THAT(wrong("4,30-1"), HasSubstr("'30-1' runs backwards"));
  EXPECT_THAT(wrong("1:9:0"), HasSubstr("has a step below 1"));
  EXPECT_THAT(wrong("1:1000000000"), HasSubstr("more than 50000 frames"));
  EXPECT_THAT(wrong("1:40000,50001:90000"), HasSubstr("more than 50000 frames"));
  EXPECT_THAT(wrong("2000000000"), HasSubstr("beyond 1000000000"));
  EXPECT_THAT(wrong("99999999999999999999"), HasSubstr("neither"));
  EXPECT_THAT(wrong("1-2x9223372036854775807"), HasSubstr("beyond 1000000000"));
  EXPECT_THAT(wrong("-9223372036854775808:5"), HasSubstr("beyond 1000000000"));
}

TEST(FrameNumbers, RepeatedNumbersAreReadUpToALimit) {
  EXPECT_EQ(parsed("1-30000,1-30000,1-30000,40000").size(), 30'001U);
  // A list that is too long is refused as a whole.
  EXPECT_THAT(std::string(parse_frames("1-30000,1-30000,1-30000,1-30000,40000").status().message()),
              HasSubstr("lists more than 100000 frames"));
}

TEST(FrameNumbers, TheTextOfNumbersIsReadAsTheSameNumbers) {
  EXPECT_EQ(frames_text({1, 2, 3, 4, 7, 9, 11, 20}), "1-4,7-11x2,20");
  EXPECT_EQ(frames_text({1, 3, 5, 6, 7}), "1,3,5-7");
  EXPECT_EQ(frames_text({1, 2}), "1-2");
  EXPECT_EQ(frames_text({1, 5}), "1,5");
  EXPECT_EQ(frames_text({-3, -2, -1}), "-3:-1");
  EXPECT_EQ(frames_text({}), "");
  for (const char* text : {"1-240", "1-239x2", "47,60-72", "-10:10x5,12,14-16", "3"}) {
    EXPECT_EQ(parsed(frames_text(parsed(text))), parsed(text)) << text;
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
