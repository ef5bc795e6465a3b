#include "worker/session/desk.h"

namespace bandsaw::worker {

std::shared_ptr<Outbox> Desk::open_stream() {
  auto outbox = std::make_shared<Outbox>();
  MutexLock lock(mutex_);
  outbox_ = outbox;
  outbox->push(session_.hello());
  return outbox;
}

void Desk::close_stream() {
  MutexLock lock(mutex_);
  session_.disconnected();
}

Reaction Desk::receive(const farm::ToWorker& message) {
  MutexLock lock(mutex_);
  Reaction reaction = session_.receive(message);
  for (farm::FromWorker& answer : reaction.send) {
    outbox_->push(std::move(answer));
  }
  if (reaction.away) {
    outbox_->close();
  }
  tell_when_over();
  return reaction;
}

std::chrono::milliseconds Desk::heartbeat_interval() {
  MutexLock lock(mutex_);
  return session_.heartbeat_interval();
}

std::optional<farm::FromWorker> Desk::heartbeat() {
  MutexLock lock(mutex_);
  return session_.connected() ? std::optional(session_.heartbeat()) : std::nullopt;
}

bool Desk::was_welcomed() {
  MutexLock lock(mutex_);
  return session_.was_welcomed();
}

std::string Desk::name() {
  MutexLock lock(mutex_);
  return session_.name();
}

void Desk::preparing(TaskId task, std::uint64_t prepared) {
  MutexLock lock(mutex_);
  session_.preparing(task, prepared);
}

void Desk::rendering(TaskId task, std::uint32_t rows_done) {
  MutexLock lock(mutex_);
  session_.rendering(task, rows_done);
  if (rows_done == 0) {
    outbox_->beat_now();
  }
}

bool Desk::finished(TaskId task) {
  MutexLock lock(mutex_);
  outbox_->beat_now();
  return session_.finished(task);
}

void Desk::failed(TaskId task, const std::string& reason, const std::vector<std::string>& log) {
  MutexLock lock(mutex_);
  if (std::optional<farm::FromWorker> message = session_.failed(task, reason, log)) {
    outbox_->push(*std::move(message));
  }
  tell_when_over();
}

void Desk::settled(TaskId task) {
  MutexLock lock(mutex_);
  session_.settled(task);
  tell_when_over();
}

absl::StatusOr<LeaseName> Desk::lease_of(TaskId task) {
  MutexLock lock(mutex_);
  if (!session_.connected()) {
    return absl::UnavailableError("not connected");
  }
  return session_.lease_of(task).value_or(LeaseName());
}

void Desk::drain(const std::string& reason) {
  MutexLock lock(mutex_);
  if (std::optional<farm::FromWorker> message = session_.drain(reason)) {
    outbox_->push(*std::move(message));
  }
  tell_when_over();
}

void Desk::leave() {
  MutexLock lock(mutex_);
  left_ = true;
  tell_when_over();
}

bool Desk::over() {
  MutexLock lock(mutex_);
  return is_over();
}

void Desk::pause(std::chrono::milliseconds time) {
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

void Desk::tell_when_over() {
  if (is_over()) {
    outbox_->close();
    changed_.notify_all();
  }
}

}  // namespace bandsaw::worker
