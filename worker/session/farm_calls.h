#pragma once

// The worker's calls by gRPC on its bulk channel. This is the connection for blobs and pixels,
// which is separate from the connection for heartbeats. Calls in progress are registered, so that
// shutdown can cancel them.

#include <memory>
#include <optional>
#include <set>

#include "absl/status/statusor.h"
#include "proto/farm.grpc.pb.h"
#include "proto/link/channel.h"
#include "renderlib/base/mutex.h"
#include "worker/session/coordinator_api.h"

namespace bandsaw::worker {

/// Holds the channel of the current connection. The channel changes with every reconnect.
class FarmCalls final : public CoordinatorApi {
 public:
  /// `instance`: names this process in each band that is sent.
  FarmCalls(link::JoinString join, std::string instance);
  ~FarmCalls() override;

  const link::JoinString& join() const { return join_; }
  /// Sets the channel for later calls. nullptr: not connected; calls then fail with UNAVAILABLE at
  /// once.
  void set_channel(std::shared_ptr<grpc::Channel> bulk) EXCLUDES(mutex_);
  /// Cancels all calls in progress and all later ones.
  void leave() EXCLUDES(mutex_);

  absl::Status get_blob(const wire::Digest& digest, std::uint64_t offset,
                        const TakeBytes& take) override;
  absl::StatusOr<farm::PutBandReply::Outcome> put_band(const FinishedBand& band,
                                                       const LeaseName& lease) override;

  /// A context for one call, which leave() can cancel.
  class Context {
   public:
    /// A deadline of zero means none.
    Context(FarmCalls& calls, std::chrono::milliseconds deadline);
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    grpc::ClientContext& operator*() { return context_; }
    grpc::ClientContext* get() { return &context_; }

   private:
    FarmCalls& calls_;
    grpc::ClientContext context_;
  };

 private:
  /// Returns the current channel; nullptr: not connected.
  std::shared_ptr<grpc::Channel> bulk() EXCLUDES(mutex_);

  const link::JoinString join_;
  const std::string instance_;
  Mutex mutex_;
  bool left_ GUARDED_BY(mutex_) = false;
  std::shared_ptr<grpc::Channel> bulk_ GUARDED_BY(mutex_);
  std::set<grpc::ClientContext*> open_ GUARDED_BY(mutex_);
  class BandStream;
  std::unique_ptr<BandStream> bands_;  ///< the open stream, used by put_band only; nullptr: none
};

}  // namespace bandsaw::worker
