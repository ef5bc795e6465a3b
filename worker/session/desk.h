#pragma once

// The session as the worker's threads share it: one lock, and the outbox of the present stream.

#include <memory>

#include "renderlib/base/mutex.h"
#include "worker/session/outbox.h"
#include "worker/session/session.h"

namespace bandsaw::worker {

class Desk {
 public:
  explicit Desk(Self self) : session_(std::move(self)), outbox_(std::make_shared<Outbox>()) {}

  // The stream's threads.
  /// A new stream begins: its outbox, which opens with Hello.
  std::shared_ptr<Outbox> open_stream() EXCLUDES(mutex_);
  void close_stream() EXCLUDES(mutex_);
  /// What the session makes of it; its answers are in the outbox already.
  Reaction receive(const farm::ToWorker& message) EXCLUDES(mutex_);
  std::chrono::milliseconds heartbeat_interval() EXCLUDES(mutex_);
  /// Nothing before Welcome.
  std::optional<farm::FromWorker> heartbeat() EXCLUDES(mutex_);
  bool was_welcomed() EXCLUDES(mutex_);
  std::string name() EXCLUDES(mutex_);

  // Rendering.
  void preparing(TaskId task, std::uint64_t prepared) EXCLUDES(mutex_);
  void rendering(TaskId task, std::uint32_t rows_done) EXCLUDES(mutex_);
  /// False: throw its pixels away.
  bool finished(TaskId task) EXCLUDES(mutex_);
  void failed(TaskId task, const std::string& reason, const std::vector<std::string>& log)
      EXCLUDES(mutex_);
  void settled(TaskId task) EXCLUDES(mutex_);
  /// UNAVAILABLE: no coordinator is there to take it.
  absl::StatusOr<LeaseName> lease_of(TaskId task) EXCLUDES(mutex_);

  // Leaving.
  void drain(const std::string& reason) EXCLUDES(mutex_);
  void leave() EXCLUDES(mutex_);
  /// Drained or told to leave.
  bool over() EXCLUDES(mutex_);
  /// Waits, but not longer than until it is over.
  void pause(std::chrono::milliseconds time) EXCLUDES(mutex_);

 private:
  bool is_over() const REQUIRES(mutex_) { return left_ || session_.drained(); }
  void tell_when_over() REQUIRES(mutex_);

  Mutex mutex_;
  CondVar changed_;
  Session session_ GUARDED_BY(mutex_);
  std::shared_ptr<Outbox> outbox_ GUARDED_BY(mutex_);
  bool left_ GUARDED_BY(mutex_) = false;
};

}  // namespace bandsaw::worker
