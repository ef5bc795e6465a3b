#pragma once

// Client of the farm's user service: typed calls over the gRPC stub. A call with an unknown outcome
// is retried with the same arguments (farm.proto: every call is idempotent). Calls block; one call
// at a time, except stop(), which is thread-safe.

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

/// A finished image and the scene's display settings.
struct FarmImage {
  Image image;
  Display display;
};

class FarmClient {
 public:
  /// Connects. UNAVAILABLE: no address answered. UNAUTHENTICATED: another farm answered.
  static absl::StatusOr<std::unique_ptr<FarmClient>> connect(const link::JoinString& join);
  /// Returns another client on the same connection, for concurrent calls.
  std::unique_ptr<FarmClient> another() const;
  FarmClient(const FarmClient&) = delete;
  FarmClient& operator=(const FarmClient&) = delete;

  struct MissingBlob {
    wire::Digest digest;
    /// Number of leading bytes that the farm has from an interrupted upload.
    std::uint64_t there = 0;
  };
  /// Returns those of the digests whose blobs the farm lacks.
  absl::StatusOr<std::vector<MissingBlob>> missing_blobs(const std::vector<wire::Digest>& digests);

  /// Uploads one blob on the bulk channel, beginning at `there`. After an interruption, resumes at
  /// the point that the farm reports. `sent` is called with the number of bytes sent so far.
  absl::Status put_blob(const wire::Digest& digest, absl::Span<const std::byte> bytes,
                        std::uint64_t there, const std::function<void(std::uint64_t)>& sent);

  absl::StatusOr<JobId> submit(const farm::SubmitRequest& request);

  absl::StatusOr<JobId> submit_sequence(const farm::SubmitSequenceRequest& request);
  /// Gives a frame its scene.
  absl::Status add_frame(JobId sequence, FrameNumber frame, const wire::Digest& manifest);
  /// Renders failed frames again; none: all that failed. Returns the sequence after that.
  absl::StatusOr<Progress> retry_frames(JobId sequence, const std::vector<FrameNumber>& frames);
  struct Frames {
    std::string epoch;
    std::vector<FrameView> frames;
  };
  /// Returns the frames whose FrameView::changed is above `after`, a number of the same epoch (run
  /// of the coordinator); 0: all. FAILED_PRECONDITION: the job is a single image.
  absl::StatusOr<Frames> frames(JobId sequence, std::uint64_t after = 0);

  /// Calls `changed` with each status. Returns OK after a final state. UNAVAILABLE: the connection
  /// was lost before.
  absl::Status watch(JobId job, const std::function<void(const Progress&)>& changed);

  /// Waits until the connection is re-established. False: the timeout expired, or stop() was
  /// called.
  bool wait_for_farm(std::chrono::milliseconds timeout);

  /// Sleeps for `time`, or until stop() is called.
  void pause(std::chrono::milliseconds time) EXCLUDES(mutex_);

  /// Fetches the finished image and checks its digest. DATA_LOSS: it does not match.
  absl::StatusOr<FarmImage> result(JobId job);
  /// Fetches the number of samples of each pixel of an adaptive job. DATA_LOSS as above.
  absl::StatusOr<Image> samples(JobId job);
  /// Fetches the mean of the first part of each pixel's samples (render/first_part.h). NOT_FOUND:
  /// there is none. DATA_LOSS as above.
  absl::StatusOr<Image> first_part(JobId job);
  /// Fetches the current state of the image, at most about `most_side` pixels a side; 0: full
  /// resolution. NOT_FOUND: no pixel is stored. DATA_LOSS as above.
  absl::StatusOr<FarmImage> preview(JobId job, std::uint32_t most_side);

  /// Returns the state of a job, with its error curve and shares.
  absl::StatusOr<Progress> job(JobId job);
  absl::StatusOr<std::vector<Progress>> jobs();
  absl::StatusOr<farm::ListWorkersReply> workers();
  absl::StatusOr<Progress> cancel(JobId job);
  absl::StatusOr<Progress> pause_job(JobId job);
  absl::StatusOr<Progress> resume_job(JobId job);
  absl::StatusOr<Progress> set_priority(JobId job, std::int32_t priority);
  /// Fetches the last lines of a worker's log. NOT_FOUND: no log of that name.
  absl::StatusOr<std::vector<std::string>> logs(const std::string& worker);
  /// Quarantines a worker's machine, or lifts the quarantine. NOT_FOUND: no such worker.
  absl::Status quarantine(const std::string& worker, bool lift);
  absl::StatusOr<farm::AboutReply> about();
  /// Renews a secret and returns the file with the new join string, on the coordinator's machine.
  absl::StatusOr<std::string> rotate_secret(link::Role role);
  /// Shows, makes or revokes the link for browsers. Arguments as farm.BrowserLinkRequest.
  absl::StatusOr<farm::BrowserLinkReply> browser_link(double seconds, bool revoke);
  /// Returns the reasons why the job is not done, at least one. NOT_FOUND: no such job.
  absl::StatusOr<std::vector<std::string>> why(JobId job);

  const std::string& address() const { return connected_.address; }

  /// Cancels the call in progress, and every later one, with CANCELLED. For an interrupt.
  void stop() EXCLUDES(mutex_);
  bool stopped() const EXCLUDES(mutex_);

 private:
  FarmClient(link::JoinString join, link::Connected connected);

  using ChangeJob = absl::FunctionRef<grpc::Status(grpc::ClientContext&, farm::JobStatus&)>;
  /// Makes a call that changes a job, and returns the job's state after it.
  absl::StatusOr<Progress> change(ChangeJob body);

  using OpenImage =
      std::function<std::unique_ptr<grpc::ClientReader<farm::ResultChunk>>(grpc::ClientContext&)>;
  absl::StatusOr<FarmImage> receive(JobId job, const OpenImage& open);

  /// Calls `body` with a new context for each attempt, and retries while the farm does not answer.
  absl::Status call(std::chrono::milliseconds deadline,
                    const std::function<grpc::Status(grpc::ClientContext&)>& body) EXCLUDES(mutex_);
  /// For streams: keepalive detects a dead connection, and large transfers take long.
  static constexpr std::chrono::milliseconds kNoDeadline{0};
  static constexpr std::chrono::milliseconds kRetryPause{500};
  static constexpr int kTries = 4;
  static bool outcome_unknown(const absl::Status& status);
  /// Converts the status of the last attempt to the error shown to the user.
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
