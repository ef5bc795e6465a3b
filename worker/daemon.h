#pragma once

// The worker as a whole. It keeps a session stream to the coordinator open, reconnects whenever the
// stream is lost, and connects session, cache, executor and uploader.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/link/join.h"
#include "worker/session/coordinator_api.h"
#include "worker/session/session.h"

namespace bandsaw {
struct Kernel;  // renderlib/render/kernel.h
}  // namespace bandsaw

namespace bandsaw::worker {

class LogQueue;  // worker/log_queue.h

/// Returns an object whose functions the worker calls instead of those of `calls`. `calls` outlives
/// the object. A test uses this to make a worker that returns wrong pixels.
using WrapCalls = std::function<std::unique_ptr<CoordinatorApi>(CoordinatorApi& calls)>;

struct DaemonOptions {
  link::JoinString join;
  WorkerInfo info;                          ///< its number of threads is also the size of the pool
  const Kernel* kernel = nullptr;           ///< the code that renders; nullptr: the fastest kernel
  std::string cache_folder;                 ///< the folder for blobs of scenes
  std::uint64_t cache_bytes = 16ull << 30;  ///< maximum size of that folder
  /// Returns the last lines of the log, to be sent with a failed band; may be nullptr.
  std::function<std::vector<std::string>()> log_tail;
  /// Called once, when the coordinator first admits this worker, with the coordinator's address and
  /// the name that it gave to the worker.
  std::function<void(const std::string& address, const std::string& name)> joined;
  std::shared_ptr<LogQueue> log = nullptr;  ///< lines for the coordinator; nullptr: none are sent
  /// For tests. nullptr: the calls of rendering go directly to the coordinator.
  WrapCalls wrap_calls = nullptr;
};

class Daemon {
 public:
  /// Opens the cache; does not connect. Fails if the cache's folder cannot be made or used; the
  /// error names it.
  static absl::StatusOr<std::unique_ptr<Daemon>> create(DaemonOptions options);
  ~Daemon();

  /// Runs until the worker has drained or left, or the coordinator has dismissed it permanently;
  /// then returns OK. Returns UNAUTHENTICATED or PERMISSION_DENIED if the coordinator refuses the
  /// join string and never admitted this worker before. After any other error it reconnects.
  absl::Status run();

  /// Finishes the held bands, then ends run(). May be called by any thread.
  void drain(const std::string& reason);
  /// Ends run() now. The coordinator gives the held bands to other workers. May be called by any
  /// thread.
  void leave();

 private:
  class Impl;
  explicit Daemon(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace bandsaw::worker
