#pragma once

// Shows progress as requested by the options: redrawn in place on a terminal, one line per second
// in a pipe, with an extra line for the first pixels, the same as JSON lines, or nothing.

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
  /// Prints a warning if a preview is requested but cannot be drawn.
  ProgressDisplay(const Console& console, Verbosity verbosity);
  /// Erases the drawn lines.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// Shows the progress at `now` (seconds of any steady clock); the first call also shows the
  /// header. Calls that come too soon after the previous output are skipped.
  void update(const Progress& progress, double now) EXCLUDES(mutex_);

  /// Returns true if a picture is requested and can be drawn.
  bool draws() const { return draws_; }
  /// Sets the picture to be drawn above the progress; done() leaves it on the terminal. No effect
  /// if pictures are not drawn.
  void picture(Image image, const Display& display) EXCLUDES(mutex_);

  /// Prints a message above the redrawn lines, for example "the coordinator is gone; trying again".
  /// JSON: a "note" event.
  void note(const std::string& text) EXCLUDES(mutex_);

  /// Shows the progress of a step before the render, for example "sending the scene". Rate-limited
  /// like update().
  void preparing(const std::string& what, std::uint64_t bytes_done, std::uint64_t bytes_in_all,
                 double now) EXCLUDES(mutex_);

  /// Reports that the files of a frame are written. JSON only: a "frame" event.
  void frame_written(JobId sequence, FrameNumber frame, const std::vector<std::string>& outputs,
                     const std::vector<std::string>& reports) EXCLUDES(mutex_);

  /// Ends the display and prints the final line with the image files (`outputs` may be empty) and
  /// the reports. The final line is printed even if quiet.
  void done(const Progress& progress, const std::vector<std::string>& outputs,
            const std::vector<std::string>& reports = {}) EXCLUDES(mutex_);

  /// Ends the display of a render without an image; JSON: an "ended" event. The caller prints the
  /// error.
  void ended(const Progress& progress) EXCLUDES(mutex_);

  /// Erases the drawn lines.
  void clear() EXCLUDES(mutex_);

 private:
  bool due(double now) REQUIRES(mutex_);
  void show_terminal(const Progress& progress) REQUIRES(mutex_);
  void wipe() REQUIRES(mutex_);

  const Console& console_;
  const Verbosity verbosity_;
  const bool draws_;  ///< the picture is drawn as well
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
