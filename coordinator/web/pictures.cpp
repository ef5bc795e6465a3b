// Makes pictures one at a time. The pictures that were used last are kept, within a limit of bytes,
// for further requests.

#include "coordinator/web/pictures.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "coordinator/engine/clock.h"
#include "coordinator/rpc/picture.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

constexpr double kFresh_s = 0.9;  // less than 1 s, so that a client that asks each second gets news
constexpr std::size_t kMaxBytes = 64 << 20;  // of all pictures that are kept

/// A file, and the memory that it takes from the budget Engine::images.
struct HeldFile {
  std::string bytes;
  MemoryBudget::Share share;
};

/// Encodes the image as a file, then frees the image. During encoding, the image and the file are
/// both in memory, but only one image is encoded at a time.
absl::StatusOr<Pictures::Bytes> encoded(HeldImage image, ImageFormat format) {
  ASSIGN_OR_RETURN(const std::vector<std::byte> bytes,
                   encode_image(image.result.image, format, image.result.display));
  image.result = {};
  image.share.resize(bytes.size());
  const auto file = std::make_shared<const HeldFile>(
      HeldFile{std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
               std::move(image.share)});
  return Pictures::Bytes(file, &file->bytes);
}

}  // namespace

absl::StatusOr<Pictures::Bytes> Pictures::preview(JobId id, std::uint32_t most_side,
                                                  ImageFormat format) {
  ASSIGN_OR_RETURN(const JobView job, job_view(engine_, id));
  MutexLock lock(making_);
  const Key key{id, most_side, format};
  const auto found = made_.find(key);
  const bool done = job.state == JobState::kDone;  // true: only the finished image is returned
  if (found != made_.end()) {
    Made& old = found->second;
    old.used = ++calls_;
    const bool new_enough = old.samples == job.samples_done || steady_seconds() - old.at < kFresh_s;
    if (old.whole || (!done && new_enough)) {
      return old.file;
    }
  }
  absl::StatusOr<HeldImage> picture = picture_of(engine_, job, most_side);
  const absl::StatusOr<Bytes> file =
      picture.ok() ? encoded(*std::move(picture), format) : picture.status();
  if (!file.ok()) {
    // After the last band has arrived, no picture can be made until the result is on disk. Until
    // then, the picture that was made last is returned.
    return found != made_.end() && !done ? absl::StatusOr<Bytes>(found->second.file) : file;
  }
  keep(key, {.file = *file,
             .samples = job.samples_done,
             .whole = done,
             .at = steady_seconds(),
             .used = ++calls_});
  return file;
}

void Pictures::keep(const Key& key, Made made) {
  const auto size_of = [](const Made& one) { return one.file == nullptr ? 0 : one.file->size(); };
  bytes_ += size_of(made) - size_of(made_[key]);
  made_[key] = std::move(made);
  while (bytes_ > kMaxBytes && made_.size() > 1) {
    const auto oldest = std::min_element(
        made_.begin(), made_.end(),
        [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
    bytes_ -= size_of(oldest->second);
    made_.erase(oldest);
  }
}

absl::StatusOr<Pictures::Bytes> Pictures::image(JobId job, ImageFormat format) {
  MutexLock lock(making_);
  ASSIGN_OR_RETURN(HeldImage image, result_of(engine_, job));
  return encoded(std::move(image), format);
}

absl::StatusOr<Pictures::Bytes> Pictures::report(JobId job, const MakeReport& make) {
  ASSIGN_OR_RETURN(const JobView view, job_view(engine_, job));
  MutexLock lock(making_);
  ASSIGN_OR_RETURN(const HeldImage image, result_of(engine_, job));
  return std::make_shared<const std::string>(make(view, image.result.image));
}

}  // namespace bandsaw::coordinator
