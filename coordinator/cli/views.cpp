#include "coordinator/cli/views.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/clock.h"
#include "renderlib/image/shrink.h"

namespace bandsaw::coordinator {
namespace {

/// What no terminal shows need not be sent.
constexpr std::uint32_t kTerminalSide = 256;

constexpr std::chrono::milliseconds kTick{100};
constexpr double kInterval_s = 1;
/// A look takes at most this share of the time: large images are looked at less often.
constexpr double kMostShare = 0.1;

}  // namespace

Views::Views(ProgressDisplay& display, const DisplayOptions& picture, const std::string& tev,
             const std::string& name)
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

std::uint32_t Views::most_side() const { return tev_ ? 0 : kTerminalSide; }

void Views::show(const Image& image, const Display& of_scene) {
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

void Views::lost(const absl::Status& why) {
  display_.note(absl::StrCat("warning: no viewer at ", address_, ": ", why.message(),
                             "; the image is rendered all the same"));
}

FollowedImage::FollowedImage(FarmClient& client, JobId job, Views& views)
    : views_(views), job_(job), client_(views.any() ? client.another() : nullptr) {
  if (client_ != nullptr) {
    ticker_.emplace(kTick, [this] { look(); });
  }
}

FollowedImage::~FollowedImage() {
  if (client_ != nullptr) {
    client_->stop();
  }
}

void FollowedImage::look() {
  const double begin = steady_seconds();
  if (begin < next_ || !views_.any()) {
    return;
  }
  // There may be nothing yet, or the farm may be gone for a moment: that is told where the job is.
  if (const auto picture = client_->preview(job_, views_.most_side()); picture.ok()) {
    views_.show(picture->image, picture->display);
  }
  const double end = steady_seconds();
  next_ = end + std::max(kInterval_s, (end - begin) / kMostShare);
}

}  // namespace bandsaw::coordinator
