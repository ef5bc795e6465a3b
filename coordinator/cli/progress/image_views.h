#pragma once

// Shows an image while it is rendered, for `render`, `submit` and `watch`: in the terminal
// (--preview), in a viewer (--tev), or in both.

#include <optional>
#include <string>

#include "coordinator/cli/options/options.h"
#include "coordinator/cli/progress/progress_display.h"
#include "coordinator/cli/progress/tev.h"

namespace bandsaw::coordinator {

/// The places where one image is shown. Not thread-safe, but other threads may use the
/// ProgressDisplay at the same time. If the viewer cannot be reached, a note says so once, and the
/// viewer is not used any more. The image is rendered without it.
class ImageViews {
 public:
  /// `tev` is HOST:PORT of the viewer; empty: no viewer. `name` is the image's name in the viewer.
  /// Options in `picture` override the scene's display settings. `display` MUST outlive the object.
  ImageViews(ProgressDisplay& display, const DisplayOptions& picture, const std::string& tev,
             const std::string& name);

  /// Returns true if the image is shown anywhere.
  bool any() const { return display_.draws() || tev_; }
  /// Returns a length of the image's longer side, in pixels, that is enough for all views; 0: full
  /// resolution is needed.
  std::uint32_t most_side() const;
  /// Shows the image instead of the last one. `of_scene`: the scene's display settings.
  void show(const Image& image, const Display& of_scene);

 private:
  /// Prints the note that there is no viewer.
  void lost(const absl::Status& why);

  ProgressDisplay& display_;
  const DisplayOptions picture_;
  const std::string address_;     ///< HOST:PORT of the viewer
  std::optional<TevViewer> tev_;  ///< std::nullopt: none is wanted, or it was lost
};

}  // namespace bandsaw::coordinator
