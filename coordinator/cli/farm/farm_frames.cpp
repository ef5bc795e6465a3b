// FarmClient's calls about sequences (jobs of many frames) and their frames. Also has
// FarmClient::job(), which fetches the state of any job.

#include <optional>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/farm/farm_client.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

// Longer than for other calls: a sequence may have tens of thousands of frames (kMaxFrames).
constexpr std::chrono::milliseconds kTimeout{20'000};

}  // namespace

absl::StatusOr<JobId> FarmClient::submit_sequence(const farm::SubmitSequenceRequest& request) {
  farm::SubmitReply reply;
  const auto body = [&](grpc::ClientContext& context) {
    return control_->SubmitSequence(&context, request, &reply);
  };
  RETURN_IF_ERROR(call(kTimeout, body, /*starts_job=*/true));
  return reply.job();
}

absl::Status FarmClient::add_frame(JobId sequence, FrameNumber frame,
                                   const wire::Digest& manifest) {
  farm::AddFramesRequest request;
  request.set_job(sequence);
  farm::FrameScene* const scene = request.add_scene();
  scene->set_frame(frame);
  scene->set_manifest_sha256(manifest.raw());
  farm::JobStatus reply;
  return call(kTimeout, [&](grpc::ClientContext& context) {
    return control_->AddFrames(&context, request, &reply);
  });
}

absl::StatusOr<Progress> FarmClient::retry_frames(JobId sequence,
                                                  const std::vector<FrameNumber>& frames) {
  farm::RetryFramesRequest request;
  request.set_job(sequence);
  request.mutable_frame()->Add(frames.begin(), frames.end());
  return change(
      [&](auto& context, auto& reply) { return control_->RetryFrames(&context, request, &reply); });
}

absl::StatusOr<FarmClient::Frames> FarmClient::frames(JobId sequence, std::uint64_t after) {
  farm::ListFramesRequest request;
  request.set_job(sequence);
  request.set_after(after);
  farm::ListFramesReply reply;
  RETURN_IF_ERROR(call(kTimeout, [&](grpc::ClientContext& context) {
    return control_->ListFrames(&context, request, &reply);
  }));
  Frames out{reply.epoch(), {}};
  for (const farm::Frame& frame : reply.frame()) {
    out.frames.push_back(frame_view_of(frame));
  }
  return out;
}

absl::StatusOr<Progress> FarmClient::job(JobId job) {
  std::optional<Progress> first;
  RETURN_IF_ERROR(call(kTimeout, [&](grpc::ClientContext& context) {
    farm::WatchRequest request;
    request.set_job(job);
    // The first message of Watch has all details of the job; further ones are not needed.
    const auto stream = control_->Watch(&context, request);
    farm::JobStatus message;
    if (!stream->Read(&message)) {
      return stream->Finish();
    }
    first = progress_of(message);
    context.TryCancel();
    stream->Finish();
    return grpc::Status::OK;
  }));
  return first ? absl::StatusOr<Progress>(*std::move(first))
               : absl::InternalError(absl::StrCat("the farm says nothing about job ", job));
}

}  // namespace bandsaw::coordinator
