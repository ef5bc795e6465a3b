// Parsing of times, percentages, ranges of rows and whole numbers in options of the command line. A
// time is from 0.1 s to 720 h, and rows lie in [0, 65536).

#include "coordinator/cli/options/quantities.h"

#include <gtest/gtest.h>

namespace bandsaw::coordinator {
namespace {

TEST(Quantities, ATimeIsInSecondsUnlessItHasAUnit) {
  EXPECT_EQ(parse_seconds("--time", "5s").value(), 5);
  EXPECT_EQ(parse_seconds("--time", "90").value(), 90);
  EXPECT_EQ(parse_seconds("--time", "2m").value(), 120);
  EXPECT_EQ(parse_seconds("--time", "1.5h").value(), 5400);
  EXPECT_EQ(parse_seconds("--time", "0.1s").value(), 0.1);
  for (const char* wrong :
       {"", "s", "5x", "5 s", "-5s", "1e3s", "inf", "nan", "0.05s", "721h", "5ss", "0x5s"}) {
    EXPECT_FALSE(parse_seconds("--time", wrong).ok()) << wrong;
  }
}

TEST(Quantities, PercentagesNeedAPercentSign) {
  EXPECT_EQ(parse_percent("--error", "1%").value(), 0.01);
  EXPECT_EQ(parse_percent("--error", "0.5 %").value(), 0.005);
  EXPECT_EQ(parse_percent("--error", "100%").value(), 1);
  for (const char* wrong : {"", "%", "1", "0%", "-1%", "101%", "nan%", "1%%", "1e-1%"}) {
    EXPECT_FALSE(parse_percent("--error", wrong).ok()) << wrong;
  }
}

TEST(Quantities, RowsAreAHalfOpenRange) {
  EXPECT_EQ(parse_rows("--rows", "0:1").value(), (RowRange{0, 1}));
  EXPECT_EQ(parse_rows("--rows", "120:65536").value(), (RowRange{120, 65536}));
  for (const char* wrong :
       {"", ":", "1:", ":1", "1", "2:2", "3:2", "-1:2", "0:65537", "1:2:3", "a:b", "1 :2"}) {
    EXPECT_FALSE(parse_rows("--rows", wrong).ok()) << wrong;
  }
}

TEST(Quantities, AnErrorNamesTheOptionTheRangeAndTheValue) {
  EXPECT_EQ(parse_whole("--depth", "x", 1, 9).status().message(),
            "--depth: must be a whole number in [1, 9], is 'x'");
  EXPECT_EQ(parse_whole("--depth", "9", 1, 9).value(), 9u);
  EXPECT_FALSE(parse_whole("--depth", "10", 1, 9).ok());
  EXPECT_FALSE(parse_whole("--depth", "+1", 1, 9).ok());
}

}  // namespace
}  // namespace bandsaw::coordinator
