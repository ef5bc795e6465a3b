#pragma once

// Keeps finished bands until the coordinator has acknowledged them, and sends them from a thread of
// its own, so that rendering continues.

#include <deque>
#include <functional>
#include <thread>

#include "absl/status/statusor.h"
#include "proto/farm.pb.h"
#include "renderlib/base/mutex.h"
#include "worker/executor/backoff.h"
#include "worker/executor/task.h"

namespace bandsaw::worker {

/// One attempt to send a band. INVALID_ARGUMENT, NOT_FOUND, FAILED_PRECONDITION: the band will
/// never be accepted. RESOURCE_EXHAUSTED: the coordinator's disk is full now. All other errors:
/// retry.
using SendBand = std::function<absl::StatusOr<farm::PutBandReply::Outcome>(const FinishedBand&)>;

/// Called from the uploader's thread when a band is acknowledged, or rejected with a permanent
/// error.
using Settled =
    std::function<void(TaskId, const absl::StatusOr<farm::PutBandReply::Outcome>& outcome)>;

class Uploader {
 public:
  /// `seed`: the seed of the random part of the waits between attempts.
  Uploader(SendBand send, Settled settled, std::uint64_t seed);
  /// Waits for the attempt in progress. Bands that are not acknowledged by then are lost.
  ~Uploader();
  Uploader(const Uploader&) = delete;
  Uploader& operator=(const Uploader&) = delete;

  void add(FinishedBand band) EXCLUDES(mutex_);
  /// Drops a band that is no longer wanted.
  void drop(TaskId task) EXCLUDES(mutex_);
  /// Ends the current backoff: the coordinator is reachable again.
  void retry_now() EXCLUDES(mutex_);

 private:
  void run() EXCLUDES(mutex_);
  void wait(std::chrono::milliseconds time) EXCLUDES(mutex_);

  const SendBand send_;
  const Settled settled_;
  Mutex mutex_;
  CondVar changed_;
  bool closing_ GUARDED_BY(mutex_) = false;
  bool retry_now_ GUARDED_BY(mutex_) = false;
  /// The bands that are not acknowledged. Their number is bounded, because they count against the
  /// worker's credit. The credit is the maximum number of bands that the coordinator leases to the
  /// worker at the same time.
  std::deque<std::shared_ptr<const FinishedBand>> bands_ GUARDED_BY(mutex_);
  Backoff backoff_;  ///< used by the thread only
  std::thread thread_;
};

}  // namespace bandsaw::worker
