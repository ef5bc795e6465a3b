// A register of the streams that may last long. When the server stops or a secret is renewed, the
// register ends the streams. The register does not keep the streams alive.

#include "coordinator/rpc/streams.h"

#include "proto/wire/limits.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::size_t kMaxStreams =
    3 * wire::kWorkers + 1024;  // 3 for each worker (session, bands, a blob); 1024 for users

}  // namespace

absl::Status LongStreams::add(std::weak_ptr<LongStream> stream) {
  MutexLock lock(mutex_);
  if (stopped_) {
    return absl::UnavailableError("the coordinator is being stopped");
  }
  std::erase_if(streams_, [](const auto& old) { return old.expired(); });
  if (streams_.size() >= kMaxStreams) {
    return absl::ResourceExhaustedError("too many open streams");
  }
  streams_.push_back(std::move(stream));
  return absl::OkStatus();
}

void LongStreams::stop_all(const absl::Status& why) {
  std::vector<std::weak_ptr<LongStream>> streams;
  {
    MutexLock lock(mutex_);
    stopped_ = true;
    streams.swap(streams_);
  }
  for (const std::weak_ptr<LongStream>& weak : streams) {
    if (const std::shared_ptr<LongStream> stream = weak.lock()) {
      stream->stop(why);
    }
  }
}

void LongStreams::stop_those_of(link::Role role, const absl::Status& why) {
  std::vector<std::weak_ptr<LongStream>> streams;
  {
    MutexLock lock(mutex_);
    streams = streams_;
  }
  for (const std::weak_ptr<LongStream>& weak : streams) {
    if (const std::shared_ptr<LongStream> stream = weak.lock();
        stream != nullptr && stream->role() == role) {
      stream->stop(why);
    }
  }
}

}  // namespace bandsaw::coordinator
