#pragma once

// State machine of a worker's session. It keeps the leases that the worker holds and makes the
// messages that the worker sends, without clock, thread or socket. Inputs are the coordinator's
// messages and events of rendering. Outputs are messages to send and bands to render or to stop. A
// task is a leased band, under an id of this process. Terms: proto/README.md, "Glossary".

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/farm.pb.h"
#include "worker/executor/task.h"

namespace bandsaw::worker {

/// This process's identity and capabilities, as sent in Hello.
struct WorkerInfo {
  std::string instance;  ///< 32 hexadecimal digits, constant for the life of the process
  std::string name;
  std::string build;  ///< version, compiler and CPU, for display
  std::uint32_t threads = 1;
  std::uint32_t max_bands = 3;  ///< leases that it accepts at the same time (its credit)
  std::uint32_t pixel_version = 0;
  std::uint64_t canary = 0;        ///< hash of a small test render; MUST equal the coordinator's
  std::uint64_t memory_bytes = 0;  ///< the memory that scenes may take here; 0: no limit
};

/// The coordinator dismissed this worker.
struct Dismissal {
  std::string reason;
  std::chrono::milliseconds wait{0};  ///< minimum wait before it reconnects
  bool for_ever = false;
};

/// The actions that the caller has to take after a message from the coordinator.
struct SessionEffects {
  std::vector<TaskId> stop;  ///< bands no longer wanted: cancel rendering or drop the result
  std::vector<Task> start;   ///< bands to render, in this order
  std::vector<farm::FromWorker> send;
  std::optional<Dismissal> dismissal;
};

/// Identifies a lease: its number, and the run of the coordinator (epoch) that assigned the number.
struct LeaseName {
  std::uint64_t lease = 0;
  std::string epoch;
};

/// Makes a LogLines message; each line is bounded in length and contains no line break.
farm::FromWorker log_message(const std::vector<std::string>& lines);

class Session {
 public:
  explicit Session(WorkerInfo info);

  // The stream.
  /// Returns the first message of a stream, which lists all leases held.
  farm::FromWorker hello() const;
  /// Changes the number of threads and the memory that the next Hello offers, as in WorkerInfo.
  void offer(std::uint32_t threads, std::uint64_t memory_bytes);
  /// Takes a message of the coordinator. Returns the actions that the caller has to take.
  SessionEffects receive(const farm::ToWorker& message);
  void disconnected() { connected_ = false; }
  farm::FromWorker heartbeat() const;
  std::chrono::milliseconds heartbeat_interval() const { return heartbeat_; }
  bool connected() const { return connected_; }  ///< Welcome was received on the current stream
  bool was_welcomed() const { return !name_.empty(); }  ///< Welcome was received at some time
  const std::string& name() const { return name_; }     ///< name assigned by the coordinator

  // Rendering. Calls for a band that is not held have no effect.
  /// Notes progress of the preparation. `prepared`: bytes fetched and steps done, a number that
  /// only increases (LeaseProgress in farm.proto).
  void preparing(TaskId task, std::uint64_t prepared);
  /// Notes that `rows_done` rows of the band are rendered. 0 means that rendering has begun, or
  /// that the renderer has done another step of the preparation before the first row. Such a step
  /// counts as progress of the preparation. Returns true if this is the first call for this band.
  bool rendering(TaskId task, std::uint32_t rows_done);
  /// Marks a band as finished. Returns false if the band is not held any more, because its lease
  /// was revoked. The caller then discards the pixels.
  bool finished(TaskId task);
  /// Removes a failed band. Returns the message to send, or std::nullopt in three cases: the band
  /// is not held, its lease is of an earlier epoch, or the session is not connected. In the last
  /// case the next Hello does not list the band, so the coordinator leases it again.
  std::optional<farm::FromWorker> failed(TaskId task, const std::string& reason,
                                         const std::vector<std::string>& log);
  /// Removes a band whose pixels are acknowledged.
  void settled(TaskId task);
  /// Returns the present lease of a band; std::nullopt if the band is not held.
  std::optional<LeaseName> lease_of(TaskId task) const;

  // Shutdown, and pauses.
  /// Requests no more leases. Returns the message to send, or std::nullopt if not connected. On
  /// later streams the message follows Welcome.
  std::optional<farm::FromWorker> drain(const std::string& reason);
  /// Ends the effect of drain(). On the next stream, the worker requests leases again.
  void resume() { drain_reason_.reset(); }
  bool drained() const { return drain_reason_.has_value() && held_.empty(); }

 private:
  enum class Stage { kWaiting, kPreparing, kRendering, kFinished };
  /// A band that is held. Heartbeats report the last two members as the progress of the band.
  struct Held {
    Task task;
    LeaseName name;
    Stage stage = Stage::kWaiting;
    std::uint64_t prepared = 0;   ///< progress of the preparation, a number that only increases
    std::uint32_t rows_done = 0;  ///< finished rows
  };

  void take_welcome(const farm::Welcome& welcome, SessionEffects& effects);
  void take_lease(const farm::Lease& lease, SessionEffects& effects);
  void take_revoke(const farm::Revoke& revoke, SessionEffects& effects);
  Held* find(TaskId task);
  farm::FromWorker draining_message() const;
  std::string doing() const;  ///< what the worker does, in words for display

  WorkerInfo info_;
  std::vector<Held> held_;  ///< in the order of their leases
  TaskId last_task_ = 0;
  bool connected_ = false;
  std::string name_;   ///< empty before the first Welcome
  std::string epoch_;  ///< of the last coordinator that sent Welcome
  std::chrono::milliseconds heartbeat_{1000};
  std::optional<std::string> drain_reason_;  ///< std::nullopt: not draining
};

}  // namespace bandsaw::worker
