#pragma once

// The part of a worker's session that does not depend on its transport (Work.Session by gRPC, or a
// browser's WebSocket). It checks each message and forwards it to the engine. It converts the
// engine's actions to messages, and queues these messages while the transport sends an earlier one.

#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "coordinator/engine/engine.h"
#include "coordinator/engine/worker_link.h"
#include "proto/farm.pb.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class WorkerSession : public WorkerLink {
 public:
  /// Maximum number of messages that wait for a worker to read. A worker holds at most
  /// wire::kBandsPerWorker leases, so a worker that reads its messages never has so many waiting.
  static constexpr std::size_t kMaxQueued = 1024;

  /// `peer`: the worker's address, for display. `browser`: the worker renders in a browser.
  /// `engine` MUST outlive the session.
  WorkerSession(Engine& engine, std::string peer, bool browser)
      : engine_(engine), peer_(std::move(peer)), browser_(browser) {}

  /// `epoch`: name of this run of the coordinator.
  void welcome(const action::Welcome& welcome, const std::string& epoch) override;
  void refuse(const action::Refuse& refuse) override;
  void lease(const action::Lease& lease) override;
  void revoke(const action::Revoke& revoke) override;
  void close(const std::string& reason) override { end_now(absl::AbortedError(reason)); }

 protected:
  /// Called by the transport with each message of the worker, by one thread at a time. Afterwards
  /// either calls read_next(), or ends the session because the message violates the protocol.
  /// `self` is this session.
  void received(const farm::FromWorker& message, const std::shared_ptr<WorkerLink>& self)
      EXCLUDES(mutex_);
  /// Called by the transport when write() has ended. `ok`: the message was sent.
  void sent(bool ok) EXCLUDES(mutex_);
  /// Ends the session after all messages that wait. If the session is ended more than once, the
  /// first status counts.
  void end_after_queue(const absl::Status& status) EXCLUDES(mutex_);
  /// Ends the session after the message that is being sent. All other messages are dropped.
  void end_now(const absl::Status& status) EXCLUDES(mutex_);
  /// Called by the transport exactly once, when no message can arrive any more. The engine frees
  /// the worker's leases.
  void over() EXCLUDES(mutex_);

 private:
  // The transport implements the following three functions. They may be called while `mutex_` is
  // locked. So they MUST NOT call a public or protected function of this class, because that
  // function would lock the mutex again: a deadlock.
  /// Waits for the next message.
  virtual void read_next() = 0;
  /// Sends a message, which exists until sent() is called.
  virtual void write(const farm::ToWorker& message) = 0;
  /// Ends the connection. Called once; no write() follows. `status` is OK if the worker ended its
  /// stream or was refused.
  virtual void finish(const absl::Status& status) = 0;

  absl::Status forward(const farm::FromWorker& message, const std::shared_ptr<WorkerLink>& self);
  void send(farm::ToWorker message) EXCLUDES(mutex_);
  /// Unless a write is in progress, writes the next message of the queue, or finishes the session
  /// if it is to end and the queue is empty.
  void advance() REQUIRES(mutex_);

  Engine& engine_;
  const std::string peer_;
  const bool browser_;
  std::optional<SessionId> session_;  ///< accessed by received(), then by over()
  Mutex mutex_;
  /// While writing_ is true, the first message is being written.
  std::deque<farm::ToWorker> outgoing_ GUARDED_BY(mutex_);
  bool writing_ GUARDED_BY(mutex_) = false;
  bool finished_ GUARDED_BY(mutex_) = false;
  std::optional<absl::Status> end_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
