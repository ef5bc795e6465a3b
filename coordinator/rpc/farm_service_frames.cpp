// Implements the calls of the service Farm about sequences (jobs of many frames) and their frames.

#include "coordinator/convert/farm_messages.h"
#include "coordinator/rpc/checked_messages.h"
#include "coordinator/rpc/gate.h"
#include "coordinator/rpc/job_replies.h"
#include "coordinator/rpc/services.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

using Unary = grpc::ServerUnaryReactor;

/// Maximum number of frames in a reply that have a reason (why the frame failed). Further frames
/// are sent without a reason, so that the reply fits into a message.
constexpr std::size_t kMaxReasons = 5'000;

}  // namespace

Unary* FarmService::SubmitSequence(grpc::CallbackServerContext* context,
                                   const farm::SubmitSequenceRequest* request,
                                   farm::SubmitReply* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) -> absl::Status {
    ASSIGN_OR_RETURN(SequenceSpec spec, sequence_spec(*request));
    deps_.engine.submit_sequence(std::move(spec), reply_with(reactor, reply), request->priority());
    return absl::OkStatus();
  });
}

Unary* FarmService::AddFrames(grpc::CallbackServerContext* context,
                              const farm::AddFramesRequest* request, farm::JobStatus* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) -> absl::Status {
    ASSIGN_OR_RETURN(std::vector<FrameScene> scenes, frame_scenes(*request));
    deps_.engine.add_frames(request->job(), std::move(scenes), reply_with(reactor, reply));
    return absl::OkStatus();
  });
}

Unary* FarmService::RetryFrames(grpc::CallbackServerContext* context,
                                const farm::RetryFramesRequest* request, farm::JobStatus* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) -> absl::Status {
    ASSIGN_OR_RETURN(std::vector<FrameNumber> frames, frame_numbers(*request));
    deps_.engine.retry_frames(request->job(), std::move(frames), reply_with(reactor, reply));
    return absl::OkStatus();
  });
}

Unary* FarmService::ListFrames(grpc::CallbackServerContext* context,
                               const farm::ListFramesRequest* request,
                               farm::ListFramesReply* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) {
    reply->set_epoch(deps_.engine.epoch());
    deps_.engine.frames(
        request->job(), request->after(),
        [reactor, reply](const absl::StatusOr<std::vector<FrameView>>& frames) {
          std::size_t reasons = 0;
          for (const FrameView& frame : frames.ok() ? *frames : std::vector<FrameView>()) {
            farm::Frame& message = *reply->add_frame();
            message = to_message(frame);
            if (!frame.reason.empty() && ++reasons > kMaxReasons) {
              message.clear_reason();
            }
          }
          reactor->Finish(link::to_grpc(frames.status()));
        });
    return absl::OkStatus();
  });
}

}  // namespace bandsaw::coordinator
