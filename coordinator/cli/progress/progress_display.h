#pragma once

// Shows progress the way that was asked for: redrawn in place on a terminal, a line a second in a
// pipe and one with the first pixels, JSON lines likewise, or not.

#include <string>

#include "coordinator/cli/base/console.h"
#include "coordinator/cli/options/options.h"
#include "coordinator/cli/progress/painter.h"
#include "coordinator/cli/progress/progress.h"
#include "renderlib/base/mutex.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Thread-safe.
class ProgressDisplay {
 public:
  /// A preview that is wanted where none can be drawn is said.
  ProgressDisplay(const Console& console, Verbosity verbosity);
  /// Takes away what was drawn.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// Shows the progress at `now` (seconds of any steady clock); the first call shows the header
  /// too. Calls that come sooner than is useful to show are skipped.
  void update(const Progress& progress, double now) EXCLUDES(mutex_);

  /// Whether a picture is wanted and can be drawn.
  bool draws() const { return draws_; }
  /// What is there of the image: drawn above the progress from now on, and left on the terminal by
  /// done(). Does nothing where none is drawn.
  void picture(Image image, const Display& display) EXCLUDES(mutex_);

  /// A line for people, above what is redrawn: "the coordinator is gone; trying again". JSON: a
  /// "note" event.
  void note(const std::string& text) EXCLUDES(mutex_);

  /// How much of something that comes before the render is done: "sending the scene". Shown like
  /// progress.
  void preparing(const std::string& what, std::uint64_t bytes_done, std::uint64_t bytes_in_all,
                 double now) EXCLUDES(mutex_);

  /// Ends the display, and says that the image is there (`outputs` may be empty), and its reports.
  /// The last line is said even when quiet.
  void done(const Progress& progress, const std::vector<std::string>& outputs,
            const std::vector<std::string>& reports = {}) EXCLUDES(mutex_);

  /// Ends the display of a render that gives no image; JSON: an "ended" event. The error is said by
  /// the caller.
  void ended(const Progress& progress) EXCLUDES(mutex_);

  /// Takes away what was drawn.
  void clear() EXCLUDES(mutex_);

 private:
  bool due(double now) REQUIRES(mutex_);
  void show_terminal(const Progress& progress) REQUIRES(mutex_);
  void wipe() REQUIRES(mutex_);

  const Console& console_;
  const Verbosity verbosity_;
  const bool draws_;  ///< the picture too
  Mutex mutex_;
  Painter painter_ GUARDED_BY(mutex_);
  Image image_ GUARDED_BY(mutex_);
  Display shown_as_ GUARDED_BY(mutex_);
  bool has_header_ GUARDED_BY(mutex_) = false;
  bool has_shown_ GUARDED_BY(mutex_) = false;
  bool has_pixels_ GUARDED_BY(mutex_) = false;
  double shown_at_ GUARDED_BY(mutex_) = 0;
};

}  // namespace bandsaw::coordinator
