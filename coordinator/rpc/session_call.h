#pragma once

#include "coordinator/rpc/streams.h"
#include "coordinator/rpc/worker_session.h"

namespace bandsaw::coordinator {

/// Serves Work.Session, the gRPC stream of messages between a worker and the coordinator. When the
/// stream is over, SelfOwned::OnDone calls done(), which tells the engine that the worker is lost.
/// gRPC calls OnDone exactly once, and no message of the stream can arrive after that.
class SessionCall final
    : public SelfOwned<grpc::ServerBidiReactor<farm::FromWorker, farm::ToWorker>, SessionCall>,
      public WorkerSession,
      public LongStream {
 public:
  SessionCall(const ServiceDependencies& deps, std::string peer)
      : WorkerSession(deps.engine, std::move(peer), /*browser=*/false), deps_(deps) {}
  void begin();
  void done() { over(); }

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override { sent(ok); }
  void OnCancel() override { stop(absl::CancelledError("the connection broke")); }

  void stop(const absl::Status& why) override { end_now(why); }
  link::Role role() const override { return link::Role::kWorker; }

 private:
  void read_next() override { StartRead(&incoming_); }
  void write(const farm::ToWorker& message) override { StartWrite(&message); }
  void finish(const absl::Status& status) override { Finish(link::to_grpc(status)); }

  const ServiceDependencies deps_;
  farm::FromWorker incoming_;
};

}  // namespace bandsaw::coordinator
