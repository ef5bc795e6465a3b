// next() waits for a message or until the next heartbeat is due; messages come first.

#include "worker/session/send_queue.h"

namespace bandsaw::worker {

void SendQueue::push(farm::FromWorker message) {
  MutexLock lock(mutex_);
  if (!closed_) {
    messages_.push_back(std::move(message));
    changed_.notify_all();
  }
}

void SendQueue::beat_now() {
  MutexLock lock(mutex_);
  beat_now_ = true;
  changed_.notify_all();
}

void SendQueue::close() {
  MutexLock lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

SendQueue::Next SendQueue::next(std::chrono::milliseconds heartbeat_interval,
                                farm::FromWorker& message) {
  MutexLock lock(mutex_);
  while (true) {
    if (!messages_.empty()) {
      message = std::move(messages_.front());
      messages_.pop_front();
      return Next::kMessage;
    }
    if (closed_) {
      return Next::kClosed;
    }
    const auto now = std::chrono::steady_clock::now();
    const auto due = last_beat_ + heartbeat_interval;
    if (beat_now_ || now >= due) {
      beat_now_ = false;
      last_beat_ = now;
      return Next::kHeartbeat;
    }
    changed_.wait_for(mutex_, due - now);
  }
}

}  // namespace bandsaw::worker
