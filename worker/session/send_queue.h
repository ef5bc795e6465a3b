#pragma once

// The messages that wait to be written to one session stream. Any thread adds messages. The
// stream's writing thread takes them, or learns that a heartbeat is due.

#include <chrono>
#include <deque>
#include <optional>

#include "proto/farm.pb.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::worker {

class SendQueue {
 public:
  void push(farm::FromWorker message) EXCLUDES(mutex_);
  /// Makes a heartbeat due now. To be called when the state of a band has changed.
  void beat_now() EXCLUDES(mutex_);
  /// Accepts no more messages. next() still returns the messages in the queue.
  void close() EXCLUDES(mutex_);

  enum class Next { kMessage, kHeartbeat, kClosed };
  /// Waits for one of three events, and returns it. kMessage: a message was moved from the queue to
  /// `message`. kHeartbeat: a heartbeat is due, because `heartbeat_interval` has passed since the
  /// last one or because of beat_now(). kClosed: the queue is closed and empty.
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
