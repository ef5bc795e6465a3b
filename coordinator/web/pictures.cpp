#include "coordinator/web/pictures.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/clock.h"
#include "coordinator/web/reply.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/shrink.h"
#include "renderlib/package/package.h"

namespace bandsaw::coordinator {
namespace {

constexpr double kFresh_s = 0.9;
constexpr std::size_t kMostBytes = 64 << 20;

absl::StatusOr<Pictures::Bytes> encoded(const Image& image, ImageFormat format,
                                        const Display& display) {
  ASSIGN_OR_RETURN(const std::vector<std::byte> bytes, encode_image(image, format, display));
  return std::make_shared<const std::string>(reinterpret_cast<const char*>(bytes.data()),
                                             bytes.size());
}

absl::StatusOr<StoredResult> result_of(Engine& engine, JobId job) {
  using Result = absl::StatusOr<StoredResult>;
  return ask<Result>([&](auto answer) { engine.result(job, answer); });
}

}  // namespace

absl::StatusOr<JobView> look_at(Engine& engine, JobId job) {
  using View = absl::StatusOr<JobView>;
  return ask<View>([&](auto answer) {
    engine.watch(job, [answer](View view) {
      answer(std::move(view));
      return false;
    });
  });
}

absl::StatusOr<Pictures::Bytes> Pictures::preview(JobId id, std::uint32_t most_side) {
  ASSIGN_OR_RETURN(const JobView job, look_at(engine_, id));
  MutexLock lock(making_);
  const Key key{id, most_side};
  const auto found = made_.find(key);
  if (found != made_.end()) {
    Made& old = found->second;
    old.used = ++calls_;
    const bool unchanged = old.samples == job.samples_done && job.state != JobState::kDone;
    if (old.whole || unchanged || steady_seconds() - old.at < kFresh_s) {
      return old.png;
    }
  }
  absl::StatusOr<Bytes> png = make(job, most_side);
  if (!png.ok()) {
    // Between the last band and the result on disk there is nothing newer than what was shown.
    return found != made_.end() ? absl::StatusOr<Bytes>(found->second.png) : png;
  }
  keep(key, {.png = *png,
             .samples = job.samples_done,
             .whole = job.state == JobState::kDone,
             .at = steady_seconds(),
             .used = ++calls_});
  return png;
}

absl::StatusOr<Pictures::Bytes> Pictures::make(const JobView& job, std::uint32_t most_side) {
  const RenderSettings& settings = job.spec.settings;
  const std::uint32_t side = std::max(settings.width, settings.height);
  const std::uint32_t step = (side + most_side - 1) / most_side;
  if (job.state == JobState::kDone) {
    ASSIGN_OR_RETURN(const StoredResult result, result_of(engine_, job.id));
    return encoded(shrunk(result.image, step, step), ImageFormat::kPng, result.display);
  }
  using Part = absl::StatusOr<Image>;
  ASSIGN_OR_RETURN(const Image rows,
                   ask<Part>([&](auto answer) { engine_.preview(job.id, step, answer); }));
  return encoded(shrunk(rows, step, 1), ImageFormat::kPng, display_of(job.spec.manifest));
}

void Pictures::keep(const Key& key, Made made) {
  const auto size_of = [](const Made& one) { return one.png == nullptr ? 0 : one.png->size(); };
  bytes_ += size_of(made) - size_of(made_[key]);
  made_[key] = std::move(made);
  while (bytes_ > kMostBytes && made_.size() > 1) {
    const auto oldest = std::min_element(
        made_.begin(), made_.end(),
        [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
    bytes_ -= size_of(oldest->second);
    made_.erase(oldest);
  }
}

Display Pictures::display_of(const DigestHex& manifest) {
  if (display_.first != manifest) {
    display_ = {manifest, Display()};
    const auto digest = wire::digest_from_hex(manifest);
    auto blob = digest.ok() ? engine_.blobs().get(*digest) : digest.status();
    if (blob.ok()) {
      const auto bytes = (*blob)->bytes();
      const auto info =
          package_info(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
      display_.second = info.ok() ? info->display : Display();
    }
  }
  return display_.second;
}

absl::StatusOr<Pictures::Bytes> Pictures::image(JobId job, ImageFormat format) {
  MutexLock lock(making_);
  ASSIGN_OR_RETURN(const StoredResult result, result_of(engine_, job));
  return encoded(result.image, format, result.display);
}

absl::StatusOr<Pictures::Bytes> Pictures::report(JobId job, const TellReport& tell) {
  ASSIGN_OR_RETURN(const JobView view, look_at(engine_, job));
  MutexLock lock(making_);
  ASSIGN_OR_RETURN(const StoredResult result, result_of(engine_, job));
  return std::make_shared<const std::string>(tell(view, result.image));
}

}  // namespace bandsaw::coordinator
