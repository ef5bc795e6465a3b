#pragma once

// What a worker holds and what it has to say, apart from the world: no clock, thread or socket.
// Messages of the coordinator and events of rendering go in; messages to send and orders for the
// executor come out.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/farm.pb.h"
#include "worker/executor/task.h"

namespace bandsaw::worker {

/// What Hello says of this process.
struct Self {
  std::string instance;  ///< 32 hexadecimal digits, for the life of the process
  std::string name;
  std::string build;
  std::uint32_t threads = 1;
  std::uint32_t max_bands = 3;
  std::uint32_t pixel_version = 0;
  std::uint64_t canary = 0;
};

/// The coordinator sent it away.
struct Away {
  std::string reason;
  std::chrono::milliseconds wait{0};  ///< before it may come back
  bool for_ever = false;
};

/// What a message of the coordinator leads to, in this order.
struct Reaction {
  std::vector<TaskId> stop;  ///< not wanted any more: rendering or result
  std::vector<Task> start;   ///< in the order to render
  std::vector<farm::FromWorker> send;
  std::optional<Away> away;
};

/// A lease as the coordinator that gave it knows it.
struct LeaseName {
  std::uint64_t lease = 0;
  std::string epoch;
};

/// Lines of the log as they are sent: bounded, each on one line.
farm::FromWorker log_message(const std::vector<std::string>& lines);

class Session {
 public:
  explicit Session(Self self);

  // The stream.
  /// The first message of a stream, with all that is held.
  farm::FromWorker hello() const;
  Reaction receive(const farm::ToWorker& message);
  void disconnected() { connected_ = false; }
  farm::FromWorker heartbeat() const;
  std::chrono::milliseconds heartbeat_interval() const { return heartbeat_; }
  bool connected() const { return connected_; }         ///< welcomed, on this stream
  bool was_welcomed() const { return !name_.empty(); }  ///< ever
  const std::string& name() const { return name_; }     ///< the coordinator's name for it

  // Rendering.
  void preparing(TaskId task, std::uint64_t prepared);
  void rendering(TaskId task, std::uint32_t rows_done);
  /// False: it was revoked meanwhile, its pixels are to be thrown away.
  bool finished(TaskId task);
  /// Forgets it. What to send; nothing where no one listens (the next Hello does not name it: that
  /// says it too).
  std::optional<farm::FromWorker> failed(TaskId task, const std::string& reason,
                                         const std::vector<std::string>& log);
  /// Its pixels are acknowledged.
  void settled(TaskId task);
  std::optional<LeaseName> lease_of(TaskId task) const;

  // Leaving.
  /// Wants no more; the message to send, if someone listens. On later streams it follows Welcome.
  std::optional<farm::FromWorker> drain(const std::string& reason);
  bool drained() const { return drain_reason_.has_value() && held_.empty(); }

 private:
  enum class Stage { kWaiting, kPreparing, kRendering, kFinished };
  struct Held {
    Task task;
    LeaseName name;
    Stage stage = Stage::kWaiting;
    std::uint64_t prepared = 0;
    std::uint32_t rows_done = 0;
  };

  void take_welcome(const farm::Welcome& welcome, Reaction& reaction);
  void take_lease(const farm::Lease& lease, Reaction& reaction);
  void take_revoke(const farm::Revoke& revoke, Reaction& reaction);
  Held* find(TaskId task);
  farm::FromWorker draining_message() const;
  std::string doing() const;

  const Self self_;
  std::vector<Held> held_;  ///< in the order of their leases
  TaskId last_task_ = 0;
  bool connected_ = false;
  std::string name_;
  std::string epoch_;
  std::chrono::milliseconds heartbeat_{1000};
  std::optional<std::string> drain_reason_;
};

}  // namespace bandsaw::worker
