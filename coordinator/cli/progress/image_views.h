#pragma once

// Shows an image while it is rendered: in the terminal (--preview) or in a viewer (--tev).

#include <optional>
#include <string>

#include "coordinator/cli/options/options.h"
#include "coordinator/cli/progress/progress_display.h"
#include "coordinator/cli/progress/tev.h"

namespace bandsaw::coordinator {

/// Not thread-safe, but other threads may use the display at the same time. If the viewer cannot be
/// reached, this is reported once and the viewer is not used any more; rendering does not wait for
/// it.
class ImageViews {
 public:
  /// `tev` is the viewer's HOST:PORT, or empty; `name` is the image's name there. Options in
  /// `picture` override the scene's display settings.
  ImageViews(ProgressDisplay& display, const DisplayOptions& picture, const std::string& tev,
             const std::string& name);

  bool any() const { return display_.draws() || tev_; }
  /// Returns the resolution needed, as a maximum number of pixels a side; 0: full resolution.
  std::uint32_t most_side() const;
  void show(const Image& image, const Display& of_scene);

 private:
  void lost(const absl::Status& why);

  ProgressDisplay& display_;
  const DisplayOptions picture_;
  const std::string address_;  ///< HOST:PORT of the viewer
  std::optional<TevViewer> tev_;
};

}  // namespace bandsaw::coordinator
