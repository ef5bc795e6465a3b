// The calls of FarmClient. Most are made by call(), which uses a new gRPC context for each attempt
// and retries while the farm does not answer. Calls for uploads, images and frames are in
// farm_upload.cpp, farm_result.cpp and farm_frames.cpp.

#include "coordinator/cli/farm/farm_client.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kConnectTimeout{5'000};
constexpr milliseconds kCallTimeout{10'000};
constexpr std::uint32_t kJobsPerCall = 1'000;

}  // namespace

bool FarmClient::outcome_unknown(const absl::Status& status) {
  return absl::IsUnavailable(status) || absl::IsDeadlineExceeded(status);
}

absl::StatusOr<std::unique_ptr<FarmClient>> FarmClient::connect(const link::JoinString& join) {
  ASSIGN_OR_RETURN(link::Connected connected, link::connect(join, kConnectTimeout));
  return std::unique_ptr<FarmClient>(new FarmClient(join, std::move(connected)));
}

FarmClient::FarmClient(link::JoinString join, link::Connected connected)
    : join_(std::move(join)),
      connected_(std::move(connected)),
      control_(farm::Farm::NewStub(connected_.control)),
      bulk_(farm::Farm::NewStub(connected_.bulk)) {}

std::unique_ptr<FarmClient> FarmClient::another() const {
  return std::unique_ptr<FarmClient>(new FarmClient(join_, connected_));
}

void FarmClient::stop() {
  MutexLock lock(mutex_);
  stopped_ = true;
  if (running_ != nullptr) {
    running_->TryCancel();
  }
  changed_.notify_all();
}

bool FarmClient::stopped() const {
  MutexLock lock(mutex_);
  return stopped_;
}

void FarmClient::pause(milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  MutexLock lock(mutex_);
  while (!stopped_ && std::chrono::steady_clock::now() < end) {
    changed_.wait_for(mutex_, end - std::chrono::steady_clock::now());
  }
}

absl::Status FarmClient::try_once(milliseconds deadline,
                                  const std::function<grpc::Status(grpc::ClientContext&)>& body,
                                  bool stoppable) {
  grpc::ClientContext context;
  link::prepare(context, join_, deadline);
  {
    MutexLock lock(mutex_);
    if (stopped_) {
      return absl::CancelledError("interrupted");
    }
    running_ = stoppable ? &context : nullptr;
  }
  const grpc::Status status = body(context);
  MutexLock lock(mutex_);
  running_ = nullptr;
  if (stopped_ && stoppable && !status.ok()) {
    return absl::CancelledError("interrupted");
  }
  // A coordinator that is being stopped cancels the calls in progress.
  return status.error_code() == grpc::StatusCode::CANCELLED
             ? absl::UnavailableError("the farm ended the call before it was answered")
             : link::from_grpc(status);
}

absl::Status FarmClient::call(milliseconds deadline,
                              const std::function<grpc::Status(grpc::ClientContext&)>& body,
                              bool starts_job) {
  absl::Status status = try_once(deadline, body, !starts_job);
  bool was_unknown = false;
  for (int tries = 1; tries < kTries && outcome_unknown(status); ++tries) {
    was_unknown = true;
    pause(kRetryPause);
    status = try_once(deadline, body, !starts_job);
  }
  return starts_job && was_unknown && absl::IsCancelled(status)
             ? absl::CancelledError(
                   "interrupted before the farm answered; if it has accepted the "
                   "job, `bandsaw jobs` lists it")
             : given_up(status);
}

absl::Status FarmClient::given_up(const absl::Status& status) const {
  return outcome_unknown(status)
             ? absl::UnavailableError(absl::StrCat("the farm at ", connected_.address,
                                                   " does not answer: ", status.message()))
             : status;
}

absl::StatusOr<std::vector<FarmClient::MissingBlob>> FarmClient::missing_blobs(
    const std::vector<wire::Digest>& digests) {
  std::vector<MissingBlob> missing;
  for (std::size_t first = 0; first < digests.size(); first += wire::kDigestsPerMessage) {
    farm::MissingBlobsRequest request;
    const std::size_t last = std::min(first + wire::kDigestsPerMessage, digests.size());
    for (std::size_t i = first; i < last; ++i) {
      request.add_sha256(digests[i].raw());
    }
    farm::MissingBlobsReply reply;
    RETURN_IF_ERROR(call(kCallTimeout, [&](grpc::ClientContext& context) {
      return control_->MissingBlobs(&context, request, &reply);
    }));
    for (int i = 0; i < reply.sha256_size(); ++i) {
      ASSIGN_OR_RETURN(const wire::Digest digest, wire::digest_from_raw(reply.sha256(i)));
      missing.push_back({digest, i < reply.there_size() ? reply.there(i) : 0});
    }
  }
  return missing;
}

absl::StatusOr<JobId> FarmClient::submit(const farm::SubmitRequest& request) {
  farm::SubmitReply reply;
  const auto body = [&](grpc::ClientContext& context) {
    return control_->Submit(&context, request, &reply);
  };
  RETURN_IF_ERROR(call(kCallTimeout, body, /*starts_job=*/true));
  return reply.job();
}

absl::Status FarmClient::watch(JobId job, const std::function<void(const Progress&)>& changed) {
  bool ended = false;
  const absl::Status status = try_once(kNoDeadline, [&](grpc::ClientContext& context) {
    farm::WatchRequest request;
    request.set_job(job);
    const auto stream = control_->Watch(&context, request);
    farm::JobStatus message;
    while (stream->Read(&message)) {
      const Progress progress = progress_of(message);
      ended = is_final(progress.job.state);
      changed(progress);
    }
    return stream->Finish();
  });
  if (ended) {
    return absl::OkStatus();
  }
  return status.ok() ? absl::UnavailableError("the farm ended the stream before the job was over")
                     : status;
}

bool FarmClient::wait_for_farm(milliseconds timeout) {
  constexpr milliseconds kSlice{100};  // upper bound of the delay before stop() is noticed
  const auto end = std::chrono::system_clock::now() + timeout;
  while (!stopped() && std::chrono::system_clock::now() < end) {
    if (connected_.control->WaitForConnected(std::chrono::system_clock::now() + kSlice)) {
      return true;
    }
  }
  return false;
}

absl::StatusOr<std::vector<Progress>> FarmClient::jobs() {
  std::vector<Progress> out;
  farm::ListJobsRequest request;
  request.set_most(kJobsPerCall);
  for (bool more = true; more;) {
    farm::ListJobsReply reply;
    RETURN_IF_ERROR(call(kCallTimeout, [&](grpc::ClientContext& context) {
      return control_->ListJobs(&context, request, &reply);
    }));
    for (const farm::JobStatus& status : reply.job()) {
      out.push_back(progress_of(status));
      request.set_after(status.job());
    }
    more = reply.more() && reply.job_size() > 0;
  }
  return out;
}

absl::StatusOr<farm::ListWorkersReply> FarmClient::workers() {
  farm::ListWorkersReply reply;
  RETURN_IF_ERROR(call(kCallTimeout, [&](grpc::ClientContext& context) {
    return control_->ListWorkers(&context, farm::ListWorkersRequest(), &reply);
  }));
  return reply;
}

absl::StatusOr<Progress> FarmClient::change(ChangeJob body) {
  farm::JobStatus reply;
  RETURN_IF_ERROR(call(kCallTimeout, [&](grpc::ClientContext& c) { return body(c, reply); }));
  return progress_of(reply);
}

absl::StatusOr<Progress> FarmClient::cancel(JobId job) {
  farm::CancelRequest request;
  request.set_job(job);
  return change(
      [&](auto& context, auto& reply) { return control_->Cancel(&context, request, &reply); });
}

absl::StatusOr<Progress> FarmClient::pause_job(JobId job) {
  farm::PauseRequest request;
  request.set_job(job);
  return change(
      [&](auto& context, auto& reply) { return control_->Pause(&context, request, &reply); });
}

absl::StatusOr<Progress> FarmClient::resume_job(JobId job) {
  farm::ResumeRequest request;
  request.set_job(job);
  return change(
      [&](auto& context, auto& reply) { return control_->Resume(&context, request, &reply); });
}

absl::StatusOr<Progress> FarmClient::set_priority(JobId job, std::int32_t priority) {
  farm::SetPriorityRequest request;
  request.set_job(job);
  request.set_priority(priority);
  return change(
      [&](auto& context, auto& reply) { return control_->SetPriority(&context, request, &reply); });
}

absl::StatusOr<std::vector<std::string>> FarmClient::logs(const std::string& worker) {
  farm::LogsRequest request;
  request.set_worker(worker);
  farm::LogsReply reply;
  RETURN_IF_ERROR(call(kCallTimeout, [&](grpc::ClientContext& context) {
    return control_->Logs(&context, request, &reply);
  }));
  return std::vector<std::string>(reply.line().begin(), reply.line().end());
}

absl::Status FarmClient::quarantine(const std::string& worker, bool lift) {
  farm::QuarantineRequest request;
  request.set_worker(worker);
  request.set_lift(lift);
  farm::QuarantineReply reply;
  return call(kCallTimeout, [&](grpc::ClientContext& context) {
    return control_->Quarantine(&context, request, &reply);
  });
}

absl::StatusOr<farm::AboutReply> FarmClient::about() {
  farm::AboutReply reply;
  RETURN_IF_ERROR(call(kCallTimeout, [&](grpc::ClientContext& context) {
    return control_->About(&context, farm::AboutRequest(), &reply);
  }));
  return reply;
}

absl::StatusOr<std::string> FarmClient::rotate_secret(link::Role role) {
  farm::RotateSecretRequest request;
  request.set_role(role == link::Role::kWorker ? farm::SECRET_ROLE_WORKER : farm::SECRET_ROLE_FARM);
  farm::RotateSecretReply reply;
  // There is no second attempt: it would use the old secret, which is invalid if the first attempt
  // was executed.
  RETURN_IF_ERROR(try_once(kCallTimeout, [&](grpc::ClientContext& context) {
    return control_->RotateSecret(&context, request, &reply);
  }));
  return reply.join_file();
}

absl::StatusOr<farm::BrowserLinkReply> FarmClient::browser_link(double seconds, bool revoke) {
  farm::BrowserLinkRequest request;
  request.set_seconds(seconds);
  request.set_revoke(revoke);
  farm::BrowserLinkReply reply;
  RETURN_IF_ERROR(call(kCallTimeout, [&](grpc::ClientContext& context) {
    return control_->BrowserLink(&context, request, &reply);
  }));
  return reply;
}

absl::StatusOr<std::vector<std::string>> FarmClient::why(JobId job) {
  farm::WhyRequest request;
  request.set_job(job);
  farm::WhyReply reply;
  RETURN_IF_ERROR(call(kCallTimeout, [&](grpc::ClientContext& context) {
    return control_->Why(&context, request, &reply);
  }));
  return std::vector<std::string>(reply.reason().begin(), reply.reason().end());
}

}  // namespace bandsaw::coordinator
