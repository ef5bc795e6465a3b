#pragma once

// Client of a farm's service for users (proto/farm.proto), which all commands use: typed calls over
// the gRPC stub. Calls block. Every call except watch() and rotate_secret() is repeated with the
// same arguments if its outcome is unknown. This is safe, because these calls are idempotent. Only
// stop() and stopped() may be called while another call runs.

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

/// An image of a job and the display settings of its scene.
struct FarmImage {
  Image image;
  Display display;
};

/// Errors of all calls: UNAVAILABLE: the farm did not answer, also after retries. CANCELLED: stop()
/// was called. Other errors are those that proto/farm.proto states.
class FarmClient {
 public:
  /// Connects to the farm of the join string (a line with addresses, the digest of the certificate
  /// and a secret). UNAVAILABLE: no address answered. UNAUTHENTICATED: another farm answered.
  static absl::StatusOr<std::unique_ptr<FarmClient>> connect(const link::JoinString& join);
  /// Returns another client on the same connection, for concurrent calls.
  std::unique_ptr<FarmClient> another() const;
  FarmClient(const FarmClient&) = delete;
  FarmClient& operator=(const FarmClient&) = delete;

  /// A blob (a part of a scene package, named by the SHA-256 of its bytes) that the farm lacks.
  struct MissingBlob {
    wire::Digest digest;
    /// Number of leading bytes that the farm has from an interrupted upload.
    std::uint64_t there = 0;
  };
  /// Returns the blobs that the farm lacks, among the blobs with these digests.
  absl::StatusOr<std::vector<MissingBlob>> missing_blobs(const std::vector<wire::Digest>& digests);

  /// Uploads one blob from the byte at `there` on. After an interruption, resumes at the byte that
  /// the farm reports. `sent` is called with the number of bytes of the blob that are sent so far,
  /// counted from its first byte.
  absl::Status put_blob(const wire::Digest& digest, absl::Span<const std::byte> bytes,
                        std::uint64_t there, const std::function<void(std::uint64_t)>& sent);

  /// Starts a job. FAILED_PRECONDITION: the farm lacks a blob of the scene. stop() does not end an
  /// attempt of submit() or of submit_sequence(). Otherwise the user would not learn the number of
  /// a job that the farm has accepted.
  absl::StatusOr<JobId> submit(const farm::SubmitRequest& request);

  /// Starts a sequence (a job of many frames), whose scenes add_frame() names one by one.
  absl::StatusOr<JobId> submit_sequence(const farm::SubmitSequenceRequest& request);
  /// Gives a frame its scene, whose blobs were uploaded. `manifest`: digest of the manifest, the
  /// blob that names the other blobs of the scene. FAILED_PRECONDITION: the farm lacks a blob.
  absl::Status add_frame(JobId sequence, FrameNumber frame, const wire::Digest& manifest);
  /// Renders failed frames again. If `frames` is empty, renders all failed frames again. Returns
  /// the sequence's state after this change.
  absl::StatusOr<Progress> retry_frames(JobId sequence, const std::vector<FrameNumber>& frames);
  struct Frames {
    std::string epoch;  ///< names the run of the coordinator, from its start to its end
    std::vector<FrameView> frames;
  };
  /// Returns the frames whose FrameView::changed is above `after`: they changed since a former
  /// call. `after`: the largest FrameView::changed that the former call returned; 0: all frames are
  /// returned. If the epoch differs from that of the former call, the numbers cannot be compared,
  /// and all frames must be requested. FAILED_PRECONDITION: the job is a single image.
  absl::StatusOr<Frames> frames(JobId sequence, std::uint64_t after = 0);

  /// Calls `changed` with the job's status now and after each change. Returns OK after a final
  /// state (done, failed or cancelled). UNAVAILABLE: the connection was lost before a final state;
  /// the call is not repeated.
  absl::Status watch(JobId job, const std::function<void(const Progress&)>& changed);

  /// Waits until the connection is re-established. Returns false if the timeout has expired or
  /// stop() was called.
  bool wait_for_farm(std::chrono::milliseconds timeout);

  /// Sleeps for `time`, or until stop() is called.
  void pause(std::chrono::milliseconds time) EXCLUDES(mutex_);

  /// Fetches the finished image and checks its digest. DATA_LOSS: the digest does not match.
  absl::StatusOr<FarmImage> result(JobId job);
  /// Fetches the number of samples of each pixel of an adaptive job. DATA_LOSS as in result().
  absl::StatusOr<Image> samples(JobId job);
  /// Fetches the mean of the first part of each pixel's samples (renderlib/render/first_part.h),
  /// which the denoiser needs. NOT_FOUND: there is none. DATA_LOSS as in result().
  absl::StatusOr<Image> first_part(JobId job);
  /// Fetches the unfinished image, reduced so that its longer side has at most about `most_side`
  /// pixels; 0: full resolution. Fetches the finished image if the job is done. NOT_FOUND: no pixel
  /// is stored yet. DATA_LOSS: the digest does not match.
  absl::StatusOr<FarmImage> preview(JobId job, std::uint32_t most_side);

  /// Returns the state of a job, with its error curve and the share of each worker.
  absl::StatusOr<Progress> job(JobId job);
  /// Returns the states of all jobs, ascending by id, without error curves and without the shares
  /// of the workers. Reasons are cut to 300 bytes.
  absl::StatusOr<std::vector<Progress>> jobs();
  absl::StatusOr<farm::ListWorkersReply> workers();
  // cancel(), pause_job(), resume_job() and set_priority() return the job's state after the change.
  absl::StatusOr<Progress> cancel(JobId job);
  absl::StatusOr<Progress> pause_job(JobId job);
  absl::StatusOr<Progress> resume_job(JobId job);
  absl::StatusOr<Progress> set_priority(JobId job, std::int32_t priority);
  /// Fetches the last lines of a worker's log. NOT_FOUND: no log of that name.
  absl::StatusOr<std::vector<std::string>> logs(const std::string& worker);
  /// Quarantines a worker's machine (it gets no more work), or lifts the quarantine. NOT_FOUND: no
  /// such worker.
  absl::Status quarantine(const std::string& worker, bool lift);
  /// Returns the coordinator's version, clock, free disk space and number of workers.
  absl::StatusOr<farm::AboutReply> about();
  /// Renews the secret of workers or users. Returns the path of the file, on the coordinator's
  /// machine, that has the new join string. Not retried.
  absl::StatusOr<std::string> rotate_secret(link::Role role);
  /// Returns the link by which browsers join as workers; makes it if there is none. `seconds`: the
  /// time after which the link ends; 0: the end of the link is not changed, and a new link lasts 8
  /// hours. `revoke`: the link ends now, and the reply has no link; then `seconds` MUST be 0.
  absl::StatusOr<farm::BrowserLinkReply> browser_link(double seconds, bool revoke);
  /// Returns the reasons why the job is not done, at least one. NOT_FOUND: no such job.
  absl::StatusOr<std::vector<std::string>> why(JobId job);

  const std::string& address() const { return connected_.address; }

  /// Cancels the call in progress, unless that call starts a job. The cancelled call and every
  /// later call return CANCELLED. Commands use it for Ctrl-C. Thread-safe.
  void stop() EXCLUDES(mutex_);
  bool stopped() const EXCLUDES(mutex_);

 private:
  FarmClient(link::JoinString join, link::Connected connected);

  using ChangeJob = absl::FunctionRef<grpc::Status(grpc::ClientContext&, farm::JobStatus&)>;
  /// Makes a call that changes a job, and returns the job's state after it.
  absl::StatusOr<Progress> change(ChangeJob body);

  /// Starts a call whose reply is an image in chunks.
  using OpenImage =
      std::function<std::unique_ptr<grpc::ClientReader<farm::ResultChunk>>(grpc::ClientContext&)>;
  /// Makes the call `open` and checks the image. DATA_LOSS: its digest or its size is wrong.
  absl::StatusOr<FarmImage> receive(JobId job, const OpenImage& open);

  /// Calls `body`, with a new context for each attempt, until the farm answers within `deadline`.
  /// Makes at most kTries attempts.
  /// If the call starts a job, stop() does not cancel an attempt. It ends the pauses between
  /// attempts, and no further attempt is made. If stop() is called after an attempt whose outcome
  /// is unknown, the message of CANCELLED says where the user finds the job.
  absl::Status call(std::chrono::milliseconds deadline,
                    const std::function<grpc::Status(grpc::ClientContext&)>& body,
                    bool starts_job = false) EXCLUDES(mutex_);
  /// Streams have no deadline, because large transfers take long. gRPC's keepalive detects a dead
  /// connection.
  static constexpr std::chrono::milliseconds kNoDeadline{0};
  static constexpr std::chrono::milliseconds kRetryPause{500};
  static constexpr int kTries = 4;
  /// Returns true if the status does not tell whether the farm has executed the call (UNAVAILABLE
  /// and DEADLINE_EXCEEDED).
  static bool outcome_unknown(const absl::Status& status);
  /// Converts the status of the last attempt to the error shown to the user.
  absl::Status given_up(const absl::Status& status) const;
  /// Makes one attempt to upload a blob from the byte at `offset` on.
  absl::Status put_rest(const wire::Digest& digest, absl::Span<const std::byte> bytes,
                        std::uint64_t offset, const std::function<void(std::uint64_t)>& sent)
      EXCLUDES(mutex_);
  /// Calls `body` once. `stoppable`: stop() cancels it. UNAVAILABLE: the farm does not answer, or
  /// it cancelled the call. CANCELLED: stop() was called. Returns other errors of the farm.
  absl::Status try_once(std::chrono::milliseconds deadline,
                        const std::function<grpc::Status(grpc::ClientContext&)>& body,
                        bool stoppable = true) EXCLUDES(mutex_);

  link::JoinString join_;
  link::Connected connected_;
  std::unique_ptr<farm::Farm::Stub> control_;  ///< on the connection for short calls
  std::unique_ptr<farm::Farm::Stub> bulk_;     ///< on the connection for blobs and images
  mutable Mutex mutex_;
  CondVar changed_;
  /// Context of the call that stop() cancels; nullptr: there is no such call.
  grpc::ClientContext* running_ GUARDED_BY(mutex_) = nullptr;
  bool stopped_ GUARDED_BY(mutex_) = false;
};

}  // namespace bandsaw::coordinator
