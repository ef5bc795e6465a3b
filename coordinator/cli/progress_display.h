#pragma once

// Shows progress the way that was asked for: redrawn in place on a terminal, a line a second in a
// pipe, JSON lines, or not.

#include <string>

#include "coordinator/cli/console.h"
#include "coordinator/cli/options.h"
#include "coordinator/cli/painter.h"
#include "coordinator/cli/progress.h"

namespace bandsaw::coordinator {

class ProgressDisplay {
 public:
  ProgressDisplay(const Console& console, Verbosity verbosity);
  /// Takes away what was drawn.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// Shows the progress at `now` (seconds of any steady clock); the first call shows the header
  /// too. Calls that come sooner than is useful to show are skipped.
  void update(const Progress& progress, double now);

  /// A line for people, above what is redrawn: "the coordinator is gone; trying again". JSON: a
  /// "note" event.
  void note(const std::string& text);

  /// How much of something that comes before the render is done: "sending the scene". Shown like
  /// progress.
  void preparing(const std::string& what, std::uint64_t bytes_done, std::uint64_t bytes_in_all,
                 double now);

  /// Ends the display, and says that the image is there (`outputs` may be empty), and its reports.
  /// The last line is said even when quiet.
  void done(const Progress& progress, const std::vector<std::string>& outputs,
            const std::vector<std::string>& reports = {});

  /// Ends the display of a render that gives no image; JSON: an "ended" event. The error is said by
  /// the caller.
  void ended(const Progress& progress);

  /// Takes away what was drawn.
  void clear();

 private:
  bool due(double now);
  void show_terminal(const Progress& progress);

  const Console& console_;
  Verbosity verbosity_;
  Painter painter_;
  bool has_header_ = false;
  bool has_shown_ = false;
  double shown_at_ = 0;
};

}  // namespace bandsaw::coordinator
