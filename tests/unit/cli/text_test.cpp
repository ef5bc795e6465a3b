// Texts for people: numbers, times, percentages, the width of a text in a terminal, words of a
// shell command, and the suggestion of a similar word.

#include "coordinator/cli/base/text.h"

#include <gtest/gtest.h>

#include "coordinator/cli/options/did_you_mean.h"

namespace bandsaw::coordinator {
namespace {

TEST(Text, LargeNumbersHaveTwoDigitsAndASiPrefix) {
  EXPECT_EQ(si(0), "0");
  EXPECT_EQ(si(7), "7");
  EXPECT_EQ(si(950), "950");
  EXPECT_EQ(si(999.7), "1 k");
  EXPECT_EQ(si(1250), "1.2 k");
  EXPECT_EQ(si(5.2e6), "5.2 M");
  EXPECT_EQ(si(48e6), "48 M");
  EXPECT_EQ(si(9.96e6), "10 M");
  EXPECT_EQ(si(999.6e6), "1 G");
  EXPECT_EQ(si_with(48e6, "samples"), "48 Msamples");
  EXPECT_EQ(si_with(950, "samples"), "950 samples");
}

TEST(Text, TimesAreShownAsOnAClockOrWithUnits) {
  EXPECT_EQ(clock_time(0), "0:00");
  EXPECT_EQ(clock_time(8.2), "0:09");
  EXPECT_EQ(clock_time(65), "1:05");
  EXPECT_EQ(clock_time(3723), "1:02:03");
  EXPECT_EQ(duration(0.42), "0.42 s");
  EXPECT_EQ(duration(21.4), "21.4 s");
  EXPECT_EQ(duration(99.96), "1 min 40 s");
  EXPECT_EQ(duration(200), "3 min 20 s");
  EXPECT_EQ(duration(7500), "2 h 5 min");
}

TEST(Text, PercentagesHaveTwoSignificantDigits) {
  EXPECT_EQ(percent(0.01), "1 %");
  EXPECT_EQ(percent(0.016), "1.6 %");
  EXPECT_EQ(percent(0.0099), "0.99 %");
  EXPECT_EQ(percent(0.005), "0.5 %");
  EXPECT_EQ(percent(0.123), "12 %");
  EXPECT_EQ(percent(0.00001234), "0.0012 %");
}

TEST(Text, ControlCharactersAreReplaced) {
  EXPECT_EQ(printable("a\x1b[31mb\nc\x07"), "a?[31mb c?");
  // U+009B begins a control sequence, as ESC and [ do.
  EXPECT_EQ(printable("\xC2\x9B"
                      "1m"),
            "?1m");
  EXPECT_EQ(printable("Büro · 2"), "Büro · 2");
}

TEST(Text, FitCountsColumnsAndTruncatesBetweenCharacters) {
  EXPECT_EQ(columns("a·b"), 3u);
  EXPECT_EQ(fit("Büro", 4), "Büro");
  EXPECT_EQ(fit("Bürotisch", 4), "Bür…");
  EXPECT_EQ(fit("abc", 0), "");
  EXPECT_EQ(pad_right("ü", 3), "ü  ");
  EXPECT_EQ(pad_left("ü", 3), "  ü");
}

TEST(Text, AWordForTheShellIsQuotedOnlyIfNecessary) {
  EXPECT_EQ(shell_word("out/walk.####.png"), "out/walk.####.png");
  EXPECT_EQ(shell_word("a b.png"), "'a b.png'");
  EXPECT_EQ(shell_word("it's.png"), R"('it'\''s.png')");
  EXPECT_EQ(shell_word("####.png"), "'####.png'");  // a # at the start is a comment
  EXPECT_EQ(shell_word("~/$x"), "'~/$x'");
  EXPECT_EQ(shell_word(""), "''");
}

TEST(DidYouMean, FindsTheNearestWord) {
  const std::vector<std::string> known = {"serve", "submit", "watch", "jobs", "render"};
  EXPECT_EQ(did_you_mean("rendr", known), "render");
  EXPECT_EQ(did_you_mean("sumbit", known), "submit");
  EXPECT_EQ(did_you_mean("job", known), "jobs");
  EXPECT_EQ(did_you_mean("xyzzy", known), std::nullopt);
  EXPECT_EQ(did_you_mean("", known), std::nullopt);
}

}  // namespace
}  // namespace bandsaw::coordinator
