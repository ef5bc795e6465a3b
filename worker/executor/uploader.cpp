// A thread sends the first band until it is acknowledged or refused for good, then the next one.
// After a failure it waits, longer each time; retry_now() ends the wait.

#include "worker/executor/uploader.h"

namespace bandsaw::worker {
namespace {

constexpr std::chrono::milliseconds kFullDiskWait{5000};  // no short waits: a user must free space

/// Returns true if the band need not be sent again: it is acknowledged, or will never be accepted.
bool is_final(const absl::Status& status) {
  return status.ok() || absl::IsInvalidArgument(status) || absl::IsNotFound(status) ||
         absl::IsFailedPrecondition(status);
}

}  // namespace

Uploader::Uploader(SendBand send, Settled settled, std::uint64_t seed)
    : send_(std::move(send)), settled_(std::move(settled)), backoff_(seed) {
  thread_ = std::thread([this] { run(); });
}

Uploader::~Uploader() {
  {
    MutexLock lock(mutex_);
    closing_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void Uploader::add(FinishedBand band) {
  auto kept = std::make_shared<const FinishedBand>(std::move(band));
  MutexLock lock(mutex_);
  bands_.push_back(std::move(kept));
  changed_.notify_all();
}

void Uploader::drop(TaskId task) {
  MutexLock lock(mutex_);
  std::erase_if(bands_, [task](const auto& band) { return band->task.id == task; });
}

void Uploader::retry_now() {
  MutexLock lock(mutex_);
  retry_now_ = true;
  changed_.notify_all();
}

void Uploader::run() {
  while (true) {
    std::shared_ptr<const FinishedBand> band;
    {
      MutexLock lock(mutex_);
      while (bands_.empty() && !closing_) {
        changed_.wait(mutex_);
      }
      if (closing_) {
        return;
      }
      band = bands_.front();
      retry_now_ = false;
    }
    const absl::StatusOr<farm::PutBandReply::Outcome> outcome = send_(*band);
    if (is_final(outcome.status())) {
      backoff_.reset();
      drop(band->task.id);
      settled_(band->task.id, outcome);
    } else {
      wait(absl::IsResourceExhausted(outcome.status()) ? kFullDiskWait : backoff_.next());
    }
  }
}

void Uploader::wait(std::chrono::milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  MutexLock lock(mutex_);
  while (!closing_ && !retry_now_) {
    const auto left = end - std::chrono::steady_clock::now();
    if (left <= std::chrono::steady_clock::duration::zero() || !changed_.wait_for(mutex_, left)) {
      return;
    }
  }
}

}  // namespace bandsaw::worker
