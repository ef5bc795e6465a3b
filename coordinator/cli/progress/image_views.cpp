// Shows the image while it forms: in the terminal, reduced to the size that a terminal can show,
// and in the viewer tev. If the viewer is lost, a note says so once.

#include "coordinator/cli/progress/image_views.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "renderlib/image/shrink.h"

namespace bandsaw::coordinator {
namespace {

/// Maximum number of pixels of each side of a picture for the terminal. Few terminals show more.
constexpr std::uint32_t kTerminalSide = 256;

}  // namespace

ImageViews::ImageViews(ProgressDisplay& display, const DisplayOptions& picture,
                       const std::string& tev, const std::string& name)
    : display_(display), picture_(picture), address_(tev) {
  if (!address_.empty()) {
    auto viewer = TevViewer::connect(address_, name);
    if (viewer.ok()) {
      tev_.emplace(*std::move(viewer));
    } else {
      lost(viewer.status());
    }
  }
}

std::uint32_t ImageViews::most_side() const { return tev_ ? 0 : kTerminalSide; }

void ImageViews::show(const Image& image, const Display& of_scene) {
  if (tev_) {
    if (const absl::Status shown = tev_->show(image); !shown.ok()) {
      tev_.reset();
      lost(shown);
    }
  }
  if (display_.draws()) {
    const std::uint32_t side = std::max(image.width, image.height);
    const std::uint32_t step = (side + kTerminalSide - 1) / kTerminalSide;
    display_.picture(step > 1 ? shrunk(image, step, step) : image, picture_.over(of_scene));
  }
}

void ImageViews::lost(const absl::Status& why) {
  display_.note(absl::StrCat("warning: no viewer at ", address_, ": ", why.message(),
                             "; the image is rendered without the viewer"));
}

}  // namespace bandsaw::coordinator
