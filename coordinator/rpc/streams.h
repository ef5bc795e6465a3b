#pragma once

// The parts that all calls have in common: the lifetime of reactors of gRPC's callback API, the
// check of the caller's secret, and the register of all streams, which are ended when the server
// stops or a secret is renewed.

#include <grpcpp/grpcpp.h>

#include <memory>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "coordinator/engine/engine.h"
#include "coordinator/rpc/browser_access.h"
#include "coordinator/rpc/executor.h"
#include "coordinator/rpc/gate.h"
#include "proto/link/channel.h"
#include "proto/link/identity.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// A call that may last: a worker's session, a watched job, an upload, a download.
class LongStream {
 public:
  virtual ~LongStream() = default;
  /// Ends the call with this status as soon as the write or the task in progress has ended. Nothing
  /// is started after that. May be called on any thread. If stop() is called more than once, the
  /// first status counts.
  virtual void stop(const absl::Status& why) = 0;
  /// The role whose secret opened the stream.
  virtual link::Role role() const = 0;
};

/// Thread-safe. The register does not keep the streams alive.
class LongStreams {
 public:
  /// Registers a stream. UNAVAILABLE after stop_all(); RESOURCE_EXHAUSTED: too many streams.
  absl::Status add(std::weak_ptr<LongStream> stream) EXCLUDES(mutex_);
  /// Stops all streams; later ones are refused.
  void stop_all(const absl::Status& why) EXCLUDES(mutex_);
  /// Stops the open streams of one role.
  void stop_those_of(link::Role role, const absl::Status& why) EXCLUDES(mutex_);

 private:
  Mutex mutex_;
  bool stopped_ GUARDED_BY(mutex_) = false;
  std::vector<std::weak_ptr<LongStream>> streams_ GUARDED_BY(mutex_);
};

/// Dependencies shared by the services. All of them outlive every call.
struct ServiceDependencies {
  Engine& engine;
  Gate& gate;
  FileExecutor& files;  ///< threads for work that waits for the disk
  /// Threads that make images. They wait for the film (the sums of all pixels of a job).
  FileExecutor& images;
  LongStreams& streams;
  BrowserAccess* browsers = nullptr;  ///< nullptr: no browser can join
};

/// The error of calls whose secret was renewed.
inline absl::Status void_secret() {
  return absl::UnauthenticatedError(
      "this secret is void: a new join string is on the coordinator's machine");
}

/// A reactor (gRPC's object for one call) that owns itself until OnDone, gRPC's last call to it.
/// Callbacks that may come later (an answer of the engine, a task of the file executor) hold it by
/// shared_from_this().
template <class Base, class Derived>
class SelfOwned : public Base, public std::enable_shared_from_this<Derived> {
 public:
  using Reactor = Base;

  /// Creates the reactor from `args` and calls its begin().
  template <class... Args>
  static Derived* make(Args&&... args) {
    auto made = std::make_shared<Derived>(std::forward<Args>(args)...);
    made->self_ = made;
    made->begin();
    return made.get();
  }
  void OnDone() final {
    const std::shared_ptr<Derived> last = std::move(self_);
    last->done();
  }

 protected:
  /// Called by OnDone(). A derived class may define a done() of its own.
  void done() {}

 private:
  std::shared_ptr<Derived> self_;
};

/// A call that is refused at once.
template <class Base>
class RefusedCall final : public Base {
 public:
  explicit RefusedCall(const absl::Status& why) { this->Finish(link::to_grpc(why)); }
  void OnDone() override { delete this; }
};

/// Authenticates a caller; every call passes through here. Returns `make()` if the caller has the
/// secret of `role` (std::nullopt: of any role), otherwise a reactor that refuses the call. `make`
/// returns a Base*.
template <class Base, class Make>
Base* if_admitted(const ServiceDependencies& deps, const grpc::CallbackServerContext& context,
                  std::optional<link::Role> role, Make make) {
  const absl::Status status = role ? deps.gate.check(context, *role) : deps.gate.check_any(context);
  return status.ok() ? make() : new RefusedCall<Base>(status);
}

/// Creates the call of a stream from `deps` and `args`, if the caller has the secret of `role`, and
/// returns it. Otherwise returns a reactor that refuses the call. The secret is checked again once
/// the stream is in the register, because a renewal of the secret ends only the streams that are
/// registered at that moment.
template <class Call, class... Args>
auto* admitted(const ServiceDependencies& deps, const grpc::CallbackServerContext& context,
               link::Role role, Args&&... args) {
  using Base = typename Call::Reactor;
  return if_admitted<Base>(deps, context, role, [&]() -> Base* {
    Call* const call = Call::make(deps, std::forward<Args>(args)...);
    if (!deps.gate.holds(context, role)) {
      call->stop(void_secret());
    }
    return call;
  });
}

/// Runs a unary RPC if the caller has the secret of `role`. `handle` is called with the reactor. If
/// `handle` returns an error, the call ends with this error. Otherwise `handle` MUST ensure that
/// Finish is called.
template <class Handle>
grpc::ServerUnaryReactor* unary(const ServiceDependencies& deps,
                                grpc::CallbackServerContext& context,
                                std::optional<link::Role> role, Handle handle) {
  return if_admitted<grpc::ServerUnaryReactor>(deps, context, role, [&] {
    grpc::ServerUnaryReactor* const reactor = context.DefaultReactor();
    if (const absl::Status status = handle(reactor); !status.ok()) {
      reactor->Finish(link::to_grpc(status));
    }
    return reactor;
  });
}

}  // namespace bandsaw::coordinator
