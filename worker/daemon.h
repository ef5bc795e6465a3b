#pragma once

// The worker as a whole: keeps a stream to the coordinator for ever, and binds session, cache,
// executor and uploader together.

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

/// Returns an implementation that is used instead of `calls`, which outlives it.
using WrapCalls = std::function<std::unique_ptr<CoordinatorApi>(CoordinatorApi& calls)>;

struct DaemonOptions {
  link::JoinString join;
  WorkerInfo info;                 ///< threads is the size of the pool too
  const Kernel* kernel = nullptr;  ///< what renders the scenes; as in Scene::build
  std::string cache_folder;
  std::uint64_t cache_bytes = 16ull << 30;
  /// The last lines of the log, for a failure's report; may be nothing.
  std::function<std::vector<std::string>()> log_tail;
  /// Told once, when the coordinator first took this worker in: the address, and the name it bears
  /// there.
  std::function<void(const std::string& address, const std::string& name)> joined;
  /// Lines of the log that were not taken yet, at most so many: for the coordinator; may be
  /// nothing.
  std::function<std::vector<std::string>(std::size_t most)> new_log_lines = nullptr;
  /// The coordinator was started again and has lost the lines that it was sent; may be nothing.
  std::function<void()> log_lines_lost = nullptr;
  /// nullptr: rendering calls the coordinator directly.
  WrapCalls wrap_calls = nullptr;
};

class Daemon {
 public:
  /// Opens the cache; does not connect yet. Any error names the folder.
  static absl::StatusOr<std::unique_ptr<Daemon>> create(DaemonOptions options);
  ~Daemon();

  /// Until it has drained or left, or the coordinator sent it away for ever: OK. UNAUTHENTICATED,
  /// PERMISSION_DENIED: the join string is not good for this farm, and never was. Everything else
  /// is waited out.
  absl::Status run();

  /// Finish what is held, then end run(). Any thread.
  void drain(const std::string& reason);
  /// End run() now; what is held is lost to this worker, and the coordinator gives it to another.
  /// Any thread.
  void leave();

 private:
  class Impl;
  explicit Daemon(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace bandsaw::worker
