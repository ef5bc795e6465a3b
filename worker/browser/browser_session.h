#pragma once

// The session of a browser's tab with the coordinator, compiled to WebAssembly. It wraps
// worker::Session, takes and returns messages as bytes, and keeps the bands that the tab holds. It
// has no clock, thread or socket. The page's JavaScript has them, and calls the session through
// exports.h.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "worker/session/session.h"

namespace bandsaw::worker {

/// A band to render. `lease`: the bytes of the farm.Lease, for BrowserRenderer.
struct BrowserBand {
  Task task;
  std::string lease;
};

/// The actions that the page's JavaScript has to take after a message from the coordinator.
struct BrowserOrders {
  std::vector<TaskId> stop;            ///< bands that are no longer wanted
  std::optional<BrowserBand> start;    ///< a band to render
  std::vector<std::string> send;       ///< messages for the coordinator
  std::optional<Dismissal> dismissal;  ///< set if the coordinator dismissed this worker
};

class BrowserSession {
 public:
  /// Makes the session of the worker `info`. It is not connected yet. INVALID_ARGUMENT: a text of
  /// `info` is empty, is too long or contains control characters, the instance does not have 32
  /// hexadecimal digits, or the number of threads is out of range.
  static absl::StatusOr<BrowserSession> create(WorkerInfo info);

  const Session& session() const { return session_; }

  // The stream of messages from and to the coordinator. Each message to send is returned as bytes.
  std::string hello() const;
  /// Changes the number of threads and the memory that the next Hello offers. `memory_bytes`: the
  /// memory that scenes may take; 0: no limit.
  void offer(std::uint32_t threads, std::uint64_t memory_bytes);
  /// INVALID_ARGUMENT: the bytes are not a message of the protocol.
  absl::StatusOr<BrowserOrders> receive(const std::string& message);
  void disconnected() { session_.disconnected(); }
  std::string heartbeat() const;

  // Rendering. Calls for a band that is not held have no effect.
  /// Notes progress of the preparation. `prepared`: bytes fetched and steps done, a number that
  /// only increases.
  void preparing(TaskId task, std::uint64_t prepared) { session_.preparing(task, prepared); }
  /// Notes that `rows_done` rows of the band are rendered, in all. `counters`: the bytes of the
  /// farm.Counters of the newly rendered rows. INVALID_ARGUMENT: these bytes are no farm.Counters.
  absl::Status rendering(TaskId task, std::uint32_t rows_done, const std::string& counters);
  /// Returns false if the band is not wanted any more.
  bool finished(TaskId task) { return session_.finished(task); }
  /// Removes a band that cannot be rendered. `log`: the last lines of the log. Returns the message
  /// to send, or an empty text.
  std::string failed(TaskId task, const std::string& reason, const std::vector<std::string>& log);

  // Sending pixels.
  /// Returns the first bytes of the body of POST /join/band: the length of the header as 4 bytes,
  /// little-endian, and the header. The caller appends the pixel sums, whose size in bytes and
  /// digest are given. UNAVAILABLE: not connected. NOT_FOUND: the band is not held.
  absl::StatusOr<std::string> band_header(TaskId task, std::uint64_t size,
                                          const wire::Digest& digest, const RenderCost& cost) const;
  /// Takes the bytes of the coordinator's farm.PutBandReply, and drops the band. Returns "stored",
  /// "duplicate" or "unwanted". INVALID_ARGUMENT: the bytes are no farm.PutBandReply.
  absl::StatusOr<std::string> band_reply(TaskId task, const std::string& reply);

  /// Requests no more leases. Returns the message to send, or an empty text.
  std::string drain(const std::string& reason);
  /// Ends the effect of drain(). On the next stream, the worker requests leases again.
  void resume() { session_.resume(); }

 private:
  /// A band that is held.
  struct Held {
    Task task;
    Counters counters;
  };

  explicit BrowserSession(WorkerInfo info) : instance_(info.instance), session_(std::move(info)) {}
  /// Removes a band after the coordinator's reply to its pixels.
  void drop(TaskId task);

  std::string instance_;
  Session session_;
  std::map<TaskId, Held> held_;
};

}  // namespace bandsaw::worker
