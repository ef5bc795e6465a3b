#pragma once

// What goes out on one stream: messages in order, and a heartbeat whenever one is due.

#include <chrono>
#include <deque>
#include <optional>

#include "proto/farm.pb.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::worker {

class Outbox {
 public:
  void push(farm::FromWorker message) EXCLUDES(mutex_);
  /// Something of note changed: the next heartbeat is due now.
  void beat_now() EXCLUDES(mutex_);
  /// Nothing more is taken; what is there is still given out.
  void close() EXCLUDES(mutex_);

  enum class Next { kMessage, kHeartbeat, kClosed };
  /// Waits for the first of: a message (moved to `message`), the heartbeat's time, the end.
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
