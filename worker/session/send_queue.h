#pragma once

// Send queue of one stream: messages in order, and a heartbeat whenever one is due.

#include <chrono>
#include <deque>
#include <optional>

#include "proto/farm.pb.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::worker {

class SendQueue {
 public:
  void push(farm::FromWorker message) EXCLUDES(mutex_);
  /// Makes a heartbeat due now, because a state changed.
  void beat_now() EXCLUDES(mutex_);
  /// Accepts no more messages; those in the queue are still returned.
  void close() EXCLUDES(mutex_);

  enum class Next { kMessage, kHeartbeat, kClosed };
  /// Waits for the first of: a message (moved to `message`), the time of a heartbeat, the end of
  /// the queue.
  Next next(std::chrono::milliseconds heartbeat_interval, farm::FromWorker& message)
      EXCLUDES(mutex_);

 private:
  Mutex mutex_;
  CondVar changed_;
  std::deque<farm::FromWorker> messages_ GUARDED_BY(mutex_);
  bool closed_ GUARDED_BY(mutex_) = false;
  bool beat_now_ GUARDED_BY(mutex_) = false;
  std::chrono::steady_clock::time_point last_beat_ GUARDED_BY(mutex_) =
      std::chrono::steady_clock::now();
};

}  // namespace bandsaw::worker
