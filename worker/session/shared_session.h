#pragma once

// The worker's session (session.h), shared by the worker's threads. It adds a lock to Session, and
// the send queue of the current stream, which gets every message that Session returns.

#include <memory>

#include "renderlib/base/mutex.h"
#include "worker/session/send_queue.h"
#include "worker/session/session.h"

namespace bandsaw::worker {

class SharedSession {
 public:
  explicit SharedSession(WorkerInfo info)
      : session_(std::move(info)), queue_(std::make_shared<SendQueue>()) {}

  // For the threads of the stream.
  /// Starts a new stream. Returns its send queue, whose first message is Hello.
  std::shared_ptr<SendQueue> open_stream() EXCLUDES(mutex_);
  void close_stream() EXCLUDES(mutex_);
  /// Processes a message of the coordinator, and puts the answers into the send queue. Returns what
  /// the caller has to do.
  SessionEffects receive(const farm::ToWorker& message) EXCLUDES(mutex_);
  std::chrono::milliseconds heartbeat_interval() EXCLUDES(mutex_);
  /// Returns the heartbeat to send; std::nullopt before Welcome.
  std::optional<farm::FromWorker> heartbeat() EXCLUDES(mutex_);
  bool was_welcomed() EXCLUDES(mutex_);
  std::string name() EXCLUDES(mutex_);

  // For the rendering threads. Calls for a band that is not held do not change the session.
  /// Notes progress of the preparation. `prepared`: bytes fetched and steps done, a number that
  /// only increases.
  void preparing(TaskId task, std::uint64_t prepared) EXCLUDES(mutex_);
  /// Notes that `rows_done` rows of the band are rendered. 0 means that rendering has begun, or
  /// that another step of the preparation is done.
  void rendering(TaskId task, std::uint32_t rows_done) EXCLUDES(mutex_);
  /// Notes that all rows of the band are rendered and that its pixels wait to be sent. Returns
  /// false if the band is no longer held; the caller then discards the pixels.
  bool finished(TaskId task) EXCLUDES(mutex_);
  /// Removes a band that failed. Sends `reason` and the lines `log` to the coordinator if the
  /// worker is connected and the band's lease is of the coordinator's present run (epoch).
  void failed(TaskId task, const std::string& reason, const std::vector<std::string>& log)
      EXCLUDES(mutex_);
  /// Removes a finished band after the coordinator has stored its pixels, or has answered that they
  /// are duplicate or unwanted.
  void settled(TaskId task) EXCLUDES(mutex_);
  /// Returns the present lease of a band; lease 0 if the band is no longer held. UNAVAILABLE: not
  /// connected to a coordinator.
  absl::StatusOr<LeaseName> lease_of(TaskId task) EXCLUDES(mutex_);

  // For shutdown.
  /// Requests no more leases. The session is over when the worker holds no more bands.
  void drain(const std::string& reason) EXCLUDES(mutex_);
  /// Ends the session without finishing the bands.
  void leave() EXCLUDES(mutex_);
  /// Returns true once the worker has drained, or after leave().
  bool over() EXCLUDES(mutex_);
  /// Sleeps, but returns early when over() becomes true.
  void pause(std::chrono::milliseconds time) EXCLUDES(mutex_);

 private:
  bool is_over() const REQUIRES(mutex_) { return left_ || session_.drained(); }
  /// If the session is over, closes the send queue and wakes the thread that sleeps in pause().
  void notify_when_over() REQUIRES(mutex_);

  Mutex mutex_;
  CondVar changed_;
  Session session_ GUARDED_BY(mutex_);
  std::shared_ptr<SendQueue> queue_ GUARDED_BY(mutex_);
  bool left_ GUARDED_BY(mutex_) = false;
};

}  // namespace bandsaw::worker
