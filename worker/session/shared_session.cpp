// Each method locks the session and calls methods of Session. If Session returns messages, they are
// put into the send queue of the current stream.

#include "worker/session/shared_session.h"

namespace bandsaw::worker {

std::shared_ptr<SendQueue> SharedSession::open_stream() {
  auto queue = std::make_shared<SendQueue>();
  MutexLock lock(mutex_);
  queue_ = queue;
  queue->push(session_.hello());
  return queue;
}

void SharedSession::close_stream() {
  MutexLock lock(mutex_);
  session_.disconnected();
}

SessionEffects SharedSession::receive(const farm::ToWorker& message) {
  MutexLock lock(mutex_);
  SessionEffects effects = session_.receive(message);
  for (farm::FromWorker& answer : effects.send) {
    queue_->push(std::move(answer));
  }
  if (effects.dismissal) {
    queue_->close();
  }
  notify_when_over();
  return effects;
}

std::chrono::milliseconds SharedSession::heartbeat_interval() {
  MutexLock lock(mutex_);
  return session_.heartbeat_interval();
}

std::optional<farm::FromWorker> SharedSession::heartbeat() {
  MutexLock lock(mutex_);
  return session_.connected() ? std::optional(session_.heartbeat()) : std::nullopt;
}

bool SharedSession::was_welcomed() {
  MutexLock lock(mutex_);
  return session_.was_welcomed();
}

std::string SharedSession::name() {
  MutexLock lock(mutex_);
  return session_.name();
}

void SharedSession::preparing(TaskId task, std::uint64_t prepared) {
  MutexLock lock(mutex_);
  session_.preparing(task, prepared);
}

void SharedSession::rendering(TaskId task, std::uint32_t rows_done) {
  MutexLock lock(mutex_);
  if (session_.rendering(task, rows_done)) {
    queue_->beat_now();
  }
}

bool SharedSession::finished(TaskId task) {
  MutexLock lock(mutex_);
  queue_->beat_now();
  return session_.finished(task);
}

void SharedSession::failed(TaskId task, const std::string& reason,
                           const std::vector<std::string>& log) {
  MutexLock lock(mutex_);
  if (std::optional<farm::FromWorker> message = session_.failed(task, reason, log)) {
    queue_->push(*std::move(message));
  }
  notify_when_over();
}

void SharedSession::settled(TaskId task) {
  MutexLock lock(mutex_);
  session_.settled(task);
  notify_when_over();
}

absl::StatusOr<LeaseName> SharedSession::lease_of(TaskId task) {
  MutexLock lock(mutex_);
  if (!session_.connected()) {
    return absl::UnavailableError("not connected");
  }
  return session_.lease_of(task).value_or(LeaseName());
}

void SharedSession::drain(const std::string& reason) {
  MutexLock lock(mutex_);
  if (std::optional<farm::FromWorker> message = session_.drain(reason)) {
    queue_->push(*std::move(message));
  }
  notify_when_over();
}

void SharedSession::leave() {
  MutexLock lock(mutex_);
  left_ = true;
  notify_when_over();
}

bool SharedSession::over() {
  MutexLock lock(mutex_);
  return is_over();
}

void SharedSession::pause(std::chrono::milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  MutexLock lock(mutex_);
  while (!is_over()) {
    const auto left = end - std::chrono::steady_clock::now();
    if (left <= std::chrono::steady_clock::duration::zero()) {
      return;
    }
    changed_.wait_for(mutex_, left);
  }
}

void SharedSession::notify_when_over() {
  if (is_over()) {
    queue_->close();
    changed_.notify_all();
  }
}

}  // namespace bandsaw::worker
