#pragma once

// Where an image is shown while it forms: the terminal (--preview), a viewer (--tev).

#include <optional>
#include <string>

#include "coordinator/cli/options/options.h"
#include "coordinator/cli/progress/progress_display.h"
#include "coordinator/cli/progress/tev.h"

namespace bandsaw::coordinator {

/// Used by one thread at a time, while others may use the display. A viewer that is not there, or
/// goes away, is said once and left out from then on: the image does not wait for it.
class Views {
 public:
  /// `tev` is the viewer's HOST:PORT, or empty; `name` is the image's, for it. `picture` stands
  /// over what the scene says of how it is shown.
  Views(ProgressDisplay& display, const DisplayOptions& picture, const std::string& tev,
        const std::string& name);

  bool any() const { return display_.draws() || tev_; }
  /// What is needed of the image: at most so many pixels a side; 0: all of them.
  std::uint32_t most_side() const;
  void show(const Image& image, const Display& of_scene);

 private:
  void lost(const absl::Status& why);

  ProgressDisplay& display_;
  const DisplayOptions picture_;
  const std::string address_;  ///< of the viewer
  std::optional<TevViewer> tev_;
};

}  // namespace bandsaw::coordinator
