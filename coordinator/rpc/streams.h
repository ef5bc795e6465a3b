#pragma once

// Lifetime of reactors of gRPC's callback API, and the registry of long streams, which the server
// must end when it stops.

#include <grpcpp/grpcpp.h>

#include <memory>
#include <vector>

#include "absl/status/status.h"
#include "coordinator/engine/engine.h"
#include "coordinator/rpc/executor.h"
#include "coordinator/rpc/gate.h"
#include "proto/link/channel.h"
#include "proto/link/identity.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// A stream that does not end by itself: a worker's session, a watched job.
class LongStream {
 public:
  virtual ~LongStream() = default;
  /// Ends the call with this status after the write in progress. Any thread; repeated calls have no
  /// effect.
  virtual void stop(const absl::Status& why) = 0;
  /// The role whose secret opened the stream.
  virtual link::Role role() const = 0;
};

class LongStreams {
 public:
  /// UNAVAILABLE after stop_all(); RESOURCE_EXHAUSTED: too many streams.
  absl::Status add(std::weak_ptr<LongStream> stream) EXCLUDES(mutex_);
  void stop_all(const absl::Status& why) EXCLUDES(mutex_);
  /// Stops the open streams of one role.
  void stop_those_of(link::Role role, const absl::Status& why) EXCLUDES(mutex_);

 private:
  Mutex mutex_;
  bool stopped_ GUARDED_BY(mutex_) = false;
  std::vector<std::weak_ptr<LongStream>> streams_ GUARDED_BY(mutex_);
};

/// Dependencies shared by the services. All of them outlive every call.
struct Doors {
  Engine& engine;
  Gate& gate;
  FileExecutor& files;
  LongStreams& streams;
};

/// A reactor that owns itself until OnDone, gRPC's last callback. Callbacks that may run after that
/// (an answer of the engine, a task of the file executor) hold it by shared_from_this().
template <class Base, class Derived>
class SelfOwned : public Base, public std::enable_shared_from_this<Derived> {
 public:
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
  void done() {}

 private:
  std::shared_ptr<Derived> self_;
};

/// Completes a unary call at once with a status.
inline grpc::ServerUnaryReactor* finished(grpc::CallbackServerContext* context,
                                          const absl::Status& status) {
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  reactor->Finish(link::to_grpc(status));
  return reactor;
}

/// A streaming call that is refused at once.
template <class Base>
class RefusedCall final : public Base {
 public:
  explicit RefusedCall(const absl::Status& why) { this->Finish(link::to_grpc(why)); }
  void OnDone() override { delete this; }
};

}  // namespace bandsaw::coordinator
