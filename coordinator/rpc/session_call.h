#pragma once

#include <deque>
#include <optional>

#include "coordinator/engine/worker_link.h"
#include "coordinator/rpc/streams.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// Work.Session: forwards a worker's messages to the engine and the engine's actions to the worker.
/// The engine receives `lost` exactly once, in OnDone, after which no message of the stream can
/// arrive.
class SessionCall final
    : public SelfOwned<grpc::ServerBidiReactor<farm::FromWorker, farm::ToWorker>, SessionCall>,
      public WorkerLink,
      public LongStream {
 public:
  SessionCall(const ServiceDependencies& deps, std::string peer)
      : deps_(deps), peer_(std::move(peer)) {}
  void begin();
  void done();

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;
  void OnCancel() override { stop(absl::CancelledError("the connection broke")); }

  void welcome(const action::Welcome& welcome, const std::string& epoch) override;
  void refuse(const action::Refuse& refuse) override;
  void lease(const action::Lease& lease) override;
  void revoke(const action::Revoke& revoke) override;
  void close(const std::string& reason) override { stop(absl::AbortedError(reason)); }
  void stop(const absl::Status& why) override EXCLUDES(mutex_);
  link::Role role() const override { return link::Role::kWorker; }

 private:
  absl::Status receive(const farm::FromWorker& message);
  void send(farm::ToWorker message) EXCLUDES(mutex_);
  /// Ends the call after all messages queued before.
  void end_with(const absl::Status& status) EXCLUDES(mutex_);
  void advance() REQUIRES(mutex_);

  const ServiceDependencies deps_;
  const std::string peer_;
  farm::FromWorker incoming_;
  std::optional<SessionId> session_;  ///< accessed by read callbacks, then by done()
  Mutex mutex_;
  std::deque<farm::ToWorker> outgoing_
      GUARDED_BY(mutex_);  ///< the front message is being written while writing_
  bool writing_ GUARDED_BY(mutex_) = false;
  bool finished_ GUARDED_BY(mutex_) = false;
  std::optional<absl::Status> end_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
