// The display of a job's progress: lines in a pipe, lines that are redrawn in a terminal, JSON, and
// a small picture. The second argument of update() is the time in seconds.

#include "coordinator/cli/progress/progress_display.h"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/progress/progress_json.h"

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Collects what a console prints. `terminal`: the console is a terminal, so that lines can be
/// redrawn.
struct Screen {
  std::string out;
  std::string err;
  Console console(bool terminal, bool colour = false) {
    return Console([this](absl::string_view text) { absl::StrAppend(&out, text); },
                   [this](absl::string_view text) { absl::StrAppend(&err, text); }, terminal,
                   colour);
  }
};

/// Returns the progress of a job with one worker. `fraction`: the share of the job that is done.
Progress displayed_progress(double fraction = 0.5) {
  Progress progress;
  progress.job.id = 3;
  progress.job.spec.name = "box";
  progress.job.spec.settings = {.width = 8, .height = 4, .max_depth = 2, .seed = 0};
  progress.job.spec.stop = StopAtSamples{16};
  progress.job.fraction = fraction;
  progress.job.workers = {{"anna", 2, 10, {0, 4}, "rendering"}};
  return progress;
}

/// Returns the JSON object of the line.
google::protobuf::Struct parsed(const std::string& line) {
  google::protobuf::Struct message;
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(line, &message).ok()) << line;
  return message;
}

TEST(ProgressDisplay, APipeGetsOneLineASecondAndNoEscapes) {
  Screen screen;
  const Console console = screen.console(false);
  ProgressDisplay display(console, {});
  // An update comes every 0.1 s for 3 s, and every second a further 25 % are done.
  for (int i = 0; i <= 30; ++i) {
    display.update(displayed_progress(i / 40.0), 100 + i * 0.1);
  }
  display.done(displayed_progress(1), {"box.png"});
  const std::vector<std::string> lines = absl::StrSplit(screen.out, '\n', absl::SkipEmpty());
  EXPECT_THAT(lines, ElementsAre("job 3 · box · 8×4 · until 16 samples", StartsWith("  0 %"),
                                 StartsWith(" 25 %"), StartsWith(" 50 %"), StartsWith(" 75 %"),
                                 "0 samples a pixel · 0 rays", "box.png · 0.00 s · 0 workers"));
  EXPECT_THAT(screen.out, Not(HasSubstr("\x1b")));
  EXPECT_EQ(screen.err, "");
}

TEST(ProgressDisplay, APipeGetsALineAtTheFirstPixels) {
  Screen screen;
  const Console console = screen.console(false);
  ProgressDisplay display(console, {});
  Progress begun = displayed_progress(0);
  display.update(begun, 100);
  begun.job.samples_done = 32;
  begun.job.fraction = 0.02;
  display.update(begun, 100.1);
  begun.job.fraction = 0.03;
  display.update(begun, 100.2);
  const std::vector<std::string> lines = absl::StrSplit(screen.out, '\n', absl::SkipEmpty());
  EXPECT_THAT(lines, ElementsAre("job 3 · box · 8×4 · until 16 samples", StartsWith("  0 %"),
                                 StartsWith("  2 %")));
}

TEST(ProgressDisplay, ATerminalIsRedrawnInPlaceAndLeftClean) {
  Screen screen;
  const Console console = screen.console(true);
  ProgressDisplay display(console, {});
  display.update(displayed_progress(0.25), 1);
  EXPECT_EQ(screen.out,
            "job 3 · box · 8×4 · until 16 samples\n"
            " 25 % ━━━━━                0 samples\x1b[K\n"
            "   anna      2 threads     10/s   rows 0–4\x1b[K\n\x1b[J");
  screen.out.clear();
  display.update(displayed_progress(0.5), 1.05);
  EXPECT_EQ(screen.out, "") << "must not be redrawn after only 50 ms";
  display.update(displayed_progress(0.5), 2);
  EXPECT_THAT(screen.out, StartsWith("\r\x1b[2A 50 %"));
  screen.out.clear();
  display.done(displayed_progress(1), {"box.png"});
  EXPECT_EQ(screen.out,
            "\r\x1b[2A\x1b[J0 samples a pixel · 0 rays\nbox.png · 0.00 s · 0 workers\n");
}

TEST(ProgressDisplay, TheHeaderIsBoldIfColoursAreWanted) {
  Screen screen;
  const Console console = screen.console(true, true);
  ProgressDisplay display(console, {});
  display.update(displayed_progress(), 1);
  EXPECT_THAT(screen.out, StartsWith("\x1b[1mjob 3"));
}

TEST(ProgressDisplay, QuietPrintsTheLastLineOnly) {
  Screen screen;
  const Console console = screen.console(true);
  ProgressDisplay display(console, {.quiet = true, .json = false});
  display.update(displayed_progress(), 1);
  display.preparing("sending", 1, 2, 1);
  display.done(displayed_progress(1), {"box.png"});
  EXPECT_EQ(screen.out, "box.png · 0.00 s · 0 workers\n");
}

TEST(ProgressDisplay, JsonIsOneValidObjectALine) {
  Screen screen;
  const Console console = screen.console(true);
  ProgressDisplay display(console, {.quiet = false, .json = true});
  // The first call shows nothing, so that a step that takes only a moment is never shown.
  display.preparing("sending the scene", 5, 20, 0);
  display.preparing("sending the scene", 10, 20, 1);
  display.update(displayed_progress(), 1);
  display.note("gone \"away\"\n");
  display.done(displayed_progress(1), {"a b.png"});
  const std::vector<std::string> lines = absl::StrSplit(screen.out, '\n', absl::SkipEmpty());
  std::vector<std::string> events;
  for (const std::string& line : lines) {
    events.push_back(parsed(line).fields().at("event").string_value());
  }
  EXPECT_THAT(events, ElementsAre("preparing", "job", "progress", "note", "done"));
  const auto progress = parsed(lines[2]);
  EXPECT_EQ(progress.fields().at("job").number_value(), 3);
  EXPECT_EQ(progress.fields().at("fraction").number_value(), 0.5);
  EXPECT_TRUE(progress.fields().at("error").has_null_value());
  EXPECT_EQ(progress.fields()
                .at("workers")
                .list_value()
                .values(0)
                .struct_value()
                .fields()
                .at("name")
                .string_value(),
            "anna");
  EXPECT_EQ(parsed(lines[4]).fields().at("outputs").list_value().values(0).string_value(),
            "a b.png");
}

TEST(ProgressDisplay, BadSamplesAreAWarningOnStandardError) {
  Screen screen;
  const Console console = screen.console(false);
  ProgressDisplay display(console, {.quiet = true, .json = false});
  Progress progress = displayed_progress(1);
  progress.job.counters.bad_samples = 1;
  progress.bad_sample_at = "pixel (1, 2), sample 3";
  display.done(progress, {"box.png"});
  EXPECT_THAT(screen.err, HasSubstr("pixel (1, 2), sample 3"));
}

TEST(Painter, TruncatesToTheWindowAndRedrawsInPlace) {
  Painter painter;
  EXPECT_EQ(painter.frame({"abcdef", "gh", "ij"}, {.columns = 5, .rows = 3}),
            "abc…\x1b[K\ngh\x1b[K\n\x1b[J");
  EXPECT_EQ(painter.frame({"k"}, {.columns = 5, .rows = 3}), "\r\x1b[2Ak\x1b[K\n\x1b[J");
  EXPECT_EQ(painter.clear(), "\r\x1b[1A\x1b[J");
  EXPECT_EQ(painter.clear(), "");
}

TEST(Json, HasTheErrorsOfTheRenderedAndOfTheCleanImage) {
  Progress progress = displayed_progress();
  progress.job.error = 0.5;
  EXPECT_FALSE(parsed(progress_json(progress, "done").str()).fields().contains("clean_error"));
  progress.clean_error = 0.25;
  const auto done = parsed(progress_json(progress, "done").str());
  EXPECT_EQ(done.fields().at("error").number_value(), 0.5);
  EXPECT_EQ(done.fields().at("clean_error").number_value(), 0.25);
}

// Bytes that are not valid UTF-8 become U+FFFD. An infinite number and an unknown number, which is
// given as -1, become null.
TEST(Json, EscapesAndRepairsInvalidUtf8) {
  JsonObject object;
  object.text("a\"b", "\\ \x01 ü \xff \xc3")
      .number("inf", 1e308 * 10)
      .number("x", 0.1)
      .known_number("u", -1);
  EXPECT_EQ(object.str(),
            "{\"a\\\"b\":\"\\\\ \\u0001 ü \xEF\xBF\xBD "
            "\xEF\xBF\xBD\",\"inf\":null,\"x\":0.1,\"u\":null}");
  parsed(object.str());
}

TEST(Console, AnErrorIsPrintedOnOneLine) {
  Screen screen;
  EXPECT_EQ(screen.console(false).fail(ExitCode::kWrong, "a\nb\x1b"), ExitCode::kWrong);
  EXPECT_EQ(screen.err, "bandsaw: a b?\n");
}

TEST(ProgressDisplay, APictureIsAboveTheProgressAndRemainsAtTheEnd) {
  Screen screen;
  const Console console = screen.console(true, true);
  ProgressDisplay display(console, {.preview = true});
  display.update(displayed_progress(), 100);
  EXPECT_THAT(screen.out, Not(HasSubstr("▀")));
  display.picture({2, 2, std::vector<Rgb>(4, Rgb{1, 0, 0})}, {});
  display.update(displayed_progress(), 101);
  EXPECT_THAT(screen.out, HasSubstr("255;0;0m▀▀\x1b[0m\x1b[K\n 50 %"));
  screen.out.clear();
  display.done(displayed_progress(1), {"box.png"});
  EXPECT_THAT(screen.out, HasSubstr("▀▀\x1b[0m\nbox.png"));
}

TEST(ProgressDisplay, WithoutColoursAMessageReplacesThePicture) {
  Screen screen;
  const Console console = screen.console(true, false);
  ProgressDisplay display(console, {.preview = true});
  EXPECT_FALSE(display.draws());
  display.picture({2, 2, std::vector<Rgb>(4)}, {});
  display.update(displayed_progress(), 100);
  display.done(displayed_progress(1), {"box.png"});
  EXPECT_THAT(screen.out, Not(HasSubstr("▀")));
  EXPECT_THAT(screen.err, HasSubstr("NO_COLOR"));
}

}  // namespace
}  // namespace bandsaw::coordinator
