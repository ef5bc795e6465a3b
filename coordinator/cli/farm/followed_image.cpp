#include "coordinator/cli/farm/followed_image.h"

#include <algorithm>
#include <chrono>

#include "coordinator/engine/clock.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::chrono::milliseconds kTick{100};
constexpr double kInterval_s = 1;
/// Fetching takes at most this share of the time, so large images are fetched less often.
constexpr double kMaxShare = 0.1;

}  // namespace

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
  // Errors are ignored: there may be no pixels, or the farm may be unreachable for a moment, which
  // the job's display reports.
  if (const auto picture = client_->preview(job_, views_.most_side()); picture.ok()) {
    views_.show(picture->image, picture->display);
  }
  const double end = steady_seconds();
  next_ = end + std::max(kInterval_s, (end - begin) / kMaxShare);
}

}  // namespace bandsaw::coordinator
