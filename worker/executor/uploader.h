#pragma once

// Keeps finished bands until the coordinator has them, and sends them from a thread of its own, so
// that rendering goes on.

#include <deque>
#include <functional>
#include <thread>

#include "absl/status/statusor.h"
#include "proto/farm.pb.h"
#include "renderlib/base/mutex.h"
#include "worker/executor/backoff.h"
#include "worker/executor/task.h"

namespace bandsaw::worker {

/// One attempt. INVALID_ARGUMENT, NOT_FOUND, FAILED_PRECONDITION: it will never be taken.
/// RESOURCE_EXHAUSTED: the coordinator has no room now. Anything else: try again.
using PutBand = std::function<absl::StatusOr<farm::PutBandReply::Outcome>(const FinishedBand&)>;

/// How a band ended: acknowledged, or with the error for which it will never be. Told from the
/// uploader's thread.
using Settled =
    std::function<void(TaskId, const absl::StatusOr<farm::PutBandReply::Outcome>& outcome)>;

class Uploader {
 public:
  Uploader(PutBand put, Settled settled, std::uint64_t seed);
  /// What is not acknowledged by now is lost. An attempt under way is waited for.
  ~Uploader();
  Uploader(const Uploader&) = delete;
  Uploader& operator=(const Uploader&) = delete;

  void add(FinishedBand band) EXCLUDES(mutex_);
  /// Not wanted any more.
  void drop(TaskId task) EXCLUDES(mutex_);
  /// The coordinator is back: try now, however long the wait was to be.
  void retry_now() EXCLUDES(mutex_);

 private:
  void run() EXCLUDES(mutex_);
  void wait(std::chrono::milliseconds time) EXCLUDES(mutex_);

  const PutBand put_;
  const Settled settled_;
  Mutex mutex_;
  CondVar changed_;
  bool closing_ GUARDED_BY(mutex_) = false;
  bool retry_now_ GUARDED_BY(mutex_) = false;
  /// Few and bounded: the coordinator leases no more bands than a worker's credits while these are
  /// open.
  std::deque<std::shared_ptr<const FinishedBand>> bands_ GUARDED_BY(mutex_);
  Backoff backoff_;  ///< the thread's own
  std::thread thread_;
};

}  // namespace bandsaw::worker
