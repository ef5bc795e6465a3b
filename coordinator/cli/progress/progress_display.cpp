// On a terminal, a Painter redraws a few lines in place. In a pipe, a line is printed about once a
// second. With --json, each line is one event.

#include "coordinator/cli/progress/progress_display.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/progress/half_blocks.h"
#include "coordinator/cli/progress/progress_json.h"
#include "coordinator/cli/progress/progress_text.h"

namespace bandsaw::coordinator {
namespace {

// Least time between two outputs in seconds. In a pipe it is just below one second, because
// update() may be called about once a second, and a call that comes a little early must not be
// skipped.
constexpr double kPipeInterval = 0.95;
constexpr double kTerminalInterval = 0.1;

constexpr char kBold[] = "\x1b[1m";
constexpr char kPlain[] = "\x1b[0m";

}  // namespace

ProgressDisplay::ProgressDisplay(const Console& console, Verbosity verbosity)
    : console_(console),
      verbosity_(verbosity),
      draws_(verbosity.preview && console.is_terminal() && console.colour()) {
  if (verbosity.preview && !draws_) {
    console_.complain(
        "--preview draws on a terminal with colours only; standard output is no such terminal, or "
        "NO_COLOR is set");
  }
}

ProgressDisplay::~ProgressDisplay() { clear(); }

bool ProgressDisplay::due(double now) {
  const bool drawn = console_.is_terminal() && !verbosity_.json;
  if (has_shown_ && now - shown_at_ < (drawn ? kTerminalInterval : kPipeInterval)) {
    return false;
  }
  has_shown_ = true;
  shown_at_ = now;
  return true;
}

void ProgressDisplay::update(const Progress& progress, double now) {
  MutexLock lock(mutex_);
  if (verbosity_.quiet) {
    return;
  }
  if (!has_header_) {
    has_header_ = true;
    has_shown_ = false;
    wipe();
    const std::string header = header_line(progress);
    console_.line(verbosity_.json     ? progress_json(progress, "job").str()
                  : console_.colour() ? absl::StrCat(kBold, header, kPlain)
                                      : header);
  }
  // The first pixels are shown at once, because users wait for them.
  if (!has_pixels_ && progress.job.samples_done > 0) {
    has_pixels_ = true;
    has_shown_ = false;
  }
  if (is_final(progress.job.state) || !due(now)) {
    return;
  }
  if (verbosity_.json) {
    console_.line(progress_json(progress, "progress").str());
  } else if (console_.is_terminal()) {
    show_terminal(progress);
  } else {
    console_.line(plain_line(progress));
  }
}

void ProgressDisplay::show_terminal(const Progress& progress) {
  const TerminalSize size = console_.size();
  constexpr std::size_t kKept = 3;  // rows kept free for the header, the bar and the cursor
  std::vector<std::string> lines = {bar_line(progress, std::max<std::size_t>(size.columns, 1) - 1)};
  constexpr std::size_t kBesidePicture = 4;  // lines for workers if a picture needs the space
  const std::size_t available =
      image_.pixels.empty() ? std::max(size.rows, kKept + 1) - kKept : kBesidePicture;
  for (std::string& line : worker_lines(progress, available)) {
    lines.push_back(std::move(line));
  }
  const TerminalSize above{std::max<std::size_t>(size.columns, 1) - 1,
                           size.rows - std::min(size.rows, lines.size() + 2)};
  console_.write(painter_.frame(lines, size, half_blocks(image_, shown_as_, above)));
}

void ProgressDisplay::picture(Image image, const Display& display) {
  if (draws_) {
    MutexLock lock(mutex_);
    image_ = std::move(image);
    shown_as_ = display;
  }
}

void ProgressDisplay::note(const std::string& text) {
  MutexLock lock(mutex_);
  wipe();
  if (verbosity_.json) {
    console_.line(JsonObject().text("event", "note").text("text", text).str());
  } else {
    console_.complain(text);
  }
}

void ProgressDisplay::preparing(const std::string& what, std::uint64_t bytes_done,
                                std::uint64_t bytes_in_all, double now) {
  MutexLock lock(mutex_);
  // The first call shows nothing, so that a step that takes only a moment is never shown.
  if (!has_shown_) {
    has_shown_ = true;
    shown_at_ = now;
  }
  if (verbosity_.quiet || !due(now)) {
    return;
  }
  if (verbosity_.json) {
    console_.line(JsonObject()
                      .text("event", "preparing")
                      .text("what", what)
                      .whole("bytes_done", bytes_done)
                      .whole("bytes", bytes_in_all)
                      .str());
    return;
  }
  const std::string line = absl::StrCat(what, ": ", si_with(static_cast<double>(bytes_done), "B"),
                                        " of ", si_with(static_cast<double>(bytes_in_all), "B"));
  if (console_.is_terminal()) {
    console_.write(painter_.frame({line}, console_.size()));
  } else {
    console_.line(line);
  }
}

void ProgressDisplay::frame_written(JobId sequence, FrameNumber frame,
                                    const std::vector<std::string>& outputs,
                                    const std::vector<std::string>& reports) {
  MutexLock lock(mutex_);
  if (verbosity_.json) {
    console_.line(JsonObject()
                      .text("event", "frame")
                      .whole("job", sequence)
                      .number("frame", static_cast<double>(frame))
                      .texts("outputs", outputs)
                      .texts("reports", reports)
                      .str());
  }
}

void ProgressDisplay::done(const Progress& progress, const std::vector<std::string>& outputs,
                           const std::vector<std::string>& reports) {
  MutexLock lock(mutex_);
  wipe();
  for (const std::string& warning : warning_lines(progress)) {
    console_.complain(warning);
  }
  if (verbosity_.json) {
    console_.line(
        progress_json(progress, "done").texts("outputs", outputs).texts("reports", reports).str());
    return;
  }
  if (!verbosity_.quiet) {
    console_.line(cost_line(progress));
    if (const std::string left_out = left_out_line(progress); !left_out.empty()) {
      console_.line(left_out);
    }
  }
  const TerminalSize size = console_.size();
  const TerminalSize available{size.columns - 1, size.rows - std::min<std::size_t>(size.rows, 4)};
  for (const std::string& line : half_blocks(image_, shown_as_, available)) {
    console_.line(line);
  }
  const std::string name =
      outputs.empty() ? absl::StrCat("job ", progress.job.id) : printable_list(outputs);
  console_.line(final_line(progress, name, printable_list(reports)));
}

void ProgressDisplay::ended(const Progress& progress) {
  MutexLock lock(mutex_);
  wipe();
  if (verbosity_.json) {
    console_.line(progress_json(progress, "ended").str());
  }
}

void ProgressDisplay::clear() {
  MutexLock lock(mutex_);
  wipe();
}

void ProgressDisplay::wipe() {
  if (const std::string bytes = painter_.clear(); !bytes.empty()) {
    console_.write(bytes);
  }
}

}  // namespace bandsaw::coordinator
