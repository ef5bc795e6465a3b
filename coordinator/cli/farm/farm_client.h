#pragma once

// The farm as a person's program sees it: typed calls over the gRPC stub. A call whose outcome is
// unknown is tried again with the same arguments (farm.proto: every call is idempotent). Blocking;
// one call at a time, `stop` from any thread.

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "coordinator/cli/progress/progress.h"
#include "proto/farm.grpc.pb.h"
#include "proto/link/channel.h"
#include "proto/wire/digest.h"
#include "renderlib/base/mutex.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// A finished image and how its scene wants it shown.
struct FarmImage {
  Image image;
  Display display;
};

class FarmClient {
 public:
  /// UNAVAILABLE: no address answered. UNAUTHENTICATED: another farm answered.
  static absl::StatusOr<std::unique_ptr<FarmClient>> connect(const link::JoinString& join);
  /// Another one over the same connection, for calls at the same time.
  std::unique_ptr<FarmClient> another() const;
  FarmClient(const FarmClient&) = delete;
  FarmClient& operator=(const FarmClient&) = delete;

  struct MissingBlob {
    wire::Digest digest;
    std::uint64_t there = 0;  ///< bytes from its beginning, of an upload that was cut
  };
  /// Those of the digests whose blobs the farm lacks.
  absl::StatusOr<std::vector<MissingBlob>> missing_blobs(const std::vector<wire::Digest>& digests);

  /// Sends one blob on the bulk channel, from `there` on, and where that is cut, from where it was;
  /// `sent` hears how far it is.
  absl::Status put_blob(const wire::Digest& digest, absl::Span<const std::byte> bytes,
                        std::uint64_t there, const std::function<void(std::uint64_t)>& sent);

  absl::StatusOr<JobId> submit(const farm::SubmitRequest& request);

  /// Calls `changed` with each state until the last; OK after a final state. UNAVAILABLE: the farm
  /// went away before it.
  absl::Status watch(JobId job, const std::function<void(const Progress&)>& changed);

  /// Waits until the connection is there again. False: the time passed, or stop() was called.
  bool wait_for_farm(std::chrono::milliseconds timeout);

  /// Waits that long, or until stop() is called.
  void pause(std::chrono::milliseconds time) EXCLUDES(mutex_);

  /// The finished image, its digest checked. DATA_LOSS: it does not match.
  absl::StatusOr<FarmImage> result(JobId job);
  /// How many samples each of its pixels has, of an adaptive job. DATA_LOSS as above.
  absl::StatusOr<Image> samples(JobId job);
  /// What is there of it, at most about `most_side` pixels a side; 0: the image's own. NOT_FOUND:
  /// nothing is. DATA_LOSS as above.
  absl::StatusOr<FarmImage> preview(JobId job, std::uint32_t most_side);

  absl::StatusOr<std::vector<Progress>> jobs();
  absl::StatusOr<farm::ListWorkersReply> workers();
  absl::StatusOr<Progress> cancel(JobId job);
  absl::StatusOr<Progress> pause_job(JobId job);
  absl::StatusOr<Progress> resume_job(JobId job);
  absl::StatusOr<Progress> set_priority(JobId job, std::int32_t priority);
  /// The last lines of a worker's log. NOT_FOUND.
  absl::StatusOr<std::vector<std::string>> logs(const std::string& worker);
  /// Keeps a worker's machine away, or lets it in again. NOT_FOUND.
  absl::Status quarantine(const std::string& worker, bool lift);
  absl::StatusOr<farm::AboutReply> about();
  /// The file of the new join string, on the coordinator's machine.
  absl::StatusOr<std::string> rotate_secret(link::Role role);
  /// Sentences, at least one. NOT_FOUND.
  absl::StatusOr<std::vector<std::string>> why(JobId job);

  const std::string& address() const { return connected_.address; }

  /// Ends the call that runs, and every later one, with CANCELLED. For an interrupt.
  void stop() EXCLUDES(mutex_);
  bool stopped() const EXCLUDES(mutex_);

 private:
  FarmClient(link::JoinString join, link::Connected connected);

  using TellJob = absl::FunctionRef<grpc::Status(grpc::ClientContext&, farm::JobStatus&)>;
  absl::StatusOr<Progress> tell(TellJob body);

  using OpenImage =
      std::function<std::unique_ptr<grpc::ClientReader<farm::ResultChunk>>(grpc::ClientContext&)>;
  absl::StatusOr<FarmImage> receive(JobId job, const OpenImage& open);

  /// Makes a context for each try, and tries again while the farm does not answer.
  absl::Status call(std::chrono::milliseconds deadline,
                    const std::function<grpc::Status(grpc::ClientContext&)>& body) EXCLUDES(mutex_);
  /// Of streams: keepalive ends a dead one, and what is big takes its time.
  static constexpr std::chrono::milliseconds kNoDeadline{0};
  static constexpr std::chrono::milliseconds kRetryPause{500};
  static constexpr int kTries = 4;
  static bool outcome_unknown(const absl::Status& status);
  /// What people are told where nothing more is tried.
  absl::Status given_up(const absl::Status& status) const;
  absl::Status put_rest(const wire::Digest& digest, absl::Span<const std::byte> bytes,
                        std::uint64_t offset, const std::function<void(std::uint64_t)>& sent)
      EXCLUDES(mutex_);
  absl::Status try_once(std::chrono::milliseconds deadline,
                        const std::function<grpc::Status(grpc::ClientContext&)>& body)
      EXCLUDES(mutex_);

  link::JoinString join_;
  link::Connected connected_;
  std::unique_ptr<farm::Farm::Stub> control_;
  std::unique_ptr<farm::Farm::Stub> bulk_;
  mutable Mutex mutex_;
  CondVar changed_;
  grpc::ClientContext* running_ GUARDED_BY(mutex_) = nullptr;
  bool stopped_ GUARDED_BY(mutex_) = false;
};

}  // namespace bandsaw::coordinator
