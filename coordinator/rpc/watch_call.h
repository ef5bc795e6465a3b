#pragma once

#include <optional>

#include "coordinator/rpc/streams.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// Serves Farm.Watch: sends the state of a job after each change. Keeps at most one unsent status
/// (a conflating queue): a slow reader receives fewer statuses, never stale ones.
class WatchCall final : public SelfOwned<grpc::ServerWriteReactor<farm::JobStatus>, WatchCall>,
                        public LongStream {
 public:
  WatchCall(const ServiceDependencies& deps, JobId job) : deps_(deps), job_(job) {}
  void begin();
  void OnWriteDone(bool ok) override;
  void OnCancel() override { stop(absl::CancelledError("the client disconnected")); }
  void stop(const absl::Status& why) override EXCLUDES(mutex_);
  link::Role role() const override { return link::Role::kFarm; }

 private:
  /// Called by the engine with each new state of the job. Returns false if no more states are
  /// wanted.
  bool changed(const absl::StatusOr<JobView>& job) EXCLUDES(mutex_);
  /// Unless a write is in progress, sends the state that waits, or finishes the call if it is to
  /// end.
  void advance() REQUIRES(mutex_);

  const ServiceDependencies deps_;
  const JobId job_;
  Mutex mutex_;
  bool writing_ GUARDED_BY(mutex_) = false;
  bool finished_ GUARDED_BY(mutex_) = false;
  std::optional<farm::JobStatus> next_ GUARDED_BY(mutex_);
  /// The status with which the call ends after `next_` is sent; std::nullopt: the call continues.
  std::optional<absl::Status> end_ GUARDED_BY(mutex_);
  farm::JobStatus sending_;  ///< not modified while writing_
};

}  // namespace bandsaw::coordinator
