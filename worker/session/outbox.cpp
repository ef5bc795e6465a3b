#include "worker/session/outbox.h"

namespace bandsaw::worker {

void Outbox::push(farm::FromWorker message) {
  MutexLock lock(mutex_);
  if (!closed_) {
    messages_.push_back(std::move(message));
    changed_.notify_all();
  }
}

void Outbox::beat_now() {
  MutexLock lock(mutex_);
  beat_now_ = true;
  changed_.notify_all();
}

void Outbox::close() {
  MutexLock lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

Outbox::Next Outbox::next(std::chrono::milliseconds heartbeat_interval, farm::FromWorker& message) {
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
