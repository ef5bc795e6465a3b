#pragma once

// Shows the progress of a render on standard output, as the options request it. With --json, lines
// of JSON are printed. Otherwise a few lines are redrawn in place on a terminal, and lines of text
// are printed elsewhere. Lines are printed about once a second, and when the first pixels are
// there. With --quiet, only the last line is printed.

#include <string>

#include "coordinator/cli/base/console.h"
#include "coordinator/cli/options/options.h"
#include "coordinator/cli/progress/painter.h"
#include "coordinator/cli/progress/progress.h"
#include "renderlib/base/mutex.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Thread-safe. Call update() while the image is rendered, then done() or ended(). `console` MUST
/// outlive the object.
class ProgressDisplay {
 public:
  /// Prints a warning if a preview is requested but the console is no terminal with colours.
  ProgressDisplay(const Console& console, Verbosity verbosity);
  /// Erases the drawn lines.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// Shows the progress at the time `now` (seconds of any steady clock); the first call also shows
  /// the header. Does nothing if it is called too soon after the last output.
  void update(const Progress& progress, double now) EXCLUDES(mutex_);

  /// Returns true if --preview is given and a picture can be drawn.
  bool draws() const { return draws_; }
  /// Sets the picture that the next update() draws above the progress; done() leaves it on the
  /// terminal. Has no effect if draws() is false.
  void picture(Image image, const Display& display) EXCLUDES(mutex_);

  /// Prints a message above the redrawn lines, for example "the coordinator is gone; trying again".
  /// With --json it is a "note" event.
  void note(const std::string& text) EXCLUDES(mutex_);

  /// Shows the progress of a step before the render, for example "sending the scene". Shows nothing
  /// if the last output is too recent. The first call counts as an output, although it shows
  /// nothing.
  void preparing(const std::string& what, std::uint64_t bytes_done, std::uint64_t bytes_in_all,
                 double now) EXCLUDES(mutex_);

  /// With --json, prints a "frame" event: the files of a frame of a sequence are written.
  void frame_written(JobId sequence, FrameNumber frame, const std::vector<std::string>& outputs,
                     const std::vector<std::string>& reports) EXCLUDES(mutex_);

  /// Ends the display of a render that has its image. Prints the warnings, the cost (not with
  /// --quiet) and a final line with the files in `outputs` and `reports`. If `outputs` is empty,
  /// the final line has the job's number instead of files.
  void done(const Progress& progress, const std::vector<std::string>& outputs,
            const std::vector<std::string>& reports = {}) EXCLUDES(mutex_);

  /// Ends the display of a render that failed or was cancelled; with --json prints an "ended"
  /// event. The caller prints the error.
  void ended(const Progress& progress) EXCLUDES(mutex_);

  /// Erases the drawn lines.
  void clear() EXCLUDES(mutex_);

 private:
  /// Returns true, and notes the time, if the last output was long enough ago.
  bool due(double now) REQUIRES(mutex_);
  /// Draws the picture, the bar and the workers on the terminal.
  void show_terminal(const Progress& progress) REQUIRES(mutex_);
  /// Erases the drawn lines.
  void wipe() REQUIRES(mutex_);

  const Console& console_;
  const Verbosity verbosity_;
  const bool draws_;  ///< the picture is drawn as well
  Mutex mutex_;
  Painter painter_ GUARDED_BY(mutex_);
  Image image_ GUARDED_BY(mutex_);              ///< the picture; without pixels: none
  Display shown_as_ GUARDED_BY(mutex_);         ///< display settings of image_
  bool has_header_ GUARDED_BY(mutex_) = false;  ///< the header was printed
  bool has_shown_ GUARDED_BY(mutex_) = false;   ///< shown_at_ is valid; false: output is due now
  bool has_pixels_ GUARDED_BY(mutex_) = false;  ///< a state with pixels was shown
  double shown_at_ GUARDED_BY(mutex_) = 0;      ///< time of the last output
};

}  // namespace bandsaw::coordinator
