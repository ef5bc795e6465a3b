// Implements the calls of the service Farm that control or explain one job.

#include "absl/strings/str_cat.h"
#include "coordinator/convert/farm_messages.h"
#include "coordinator/rpc/gate.h"
#include "coordinator/rpc/job_replies.h"
#include "coordinator/rpc/services.h"

namespace bandsaw::coordinator {
namespace {

using Unary = grpc::ServerUnaryReactor;

/// Runs a command on the engine, then replies with the job's status. `start` gives the command to
/// the engine; its parameter is the callback that receives the job after the command.
template <class Start>
Unary* job_command(const ServiceDependencies& deps, grpc::CallbackServerContext* context,
                   farm::JobStatus* reply, Start start) {
  return unary(deps, *context, link::Role::kFarm, [&](Unary* reactor) {
    start(reply_with(reactor, reply));
    return absl::OkStatus();
  });
}

}  // namespace

Unary* FarmService::Cancel(grpc::CallbackServerContext* context, const farm::CancelRequest* request,
                           farm::JobStatus* reply) {
  return job_command(deps_, context, reply,
                     [&](auto answer) { deps_.engine.cancel(request->job(), answer); });
}

Unary* FarmService::Pause(grpc::CallbackServerContext* context, const farm::PauseRequest* request,
                          farm::JobStatus* reply) {
  return job_command(deps_, context, reply,
                     [&](auto answer) { deps_.engine.pause(request->job(), answer); });
}

Unary* FarmService::Resume(grpc::CallbackServerContext* context, const farm::ResumeRequest* request,
                           farm::JobStatus* reply) {
  return job_command(deps_, context, reply,
                     [&](auto answer) { deps_.engine.resume(request->job(), answer); });
}

Unary* FarmService::SetPriority(grpc::CallbackServerContext* context,
                                const farm::SetPriorityRequest* request, farm::JobStatus* reply) {
  return job_command(deps_, context, reply, [&](auto answer) {
    deps_.engine.set_priority(request->job(), request->priority(), answer);
  });
}

Unary* FarmService::Why(grpc::CallbackServerContext* context, const farm::WhyRequest* request,
                        farm::WhyReply* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) {
    const JobId job = request->job();
    deps_.engine.why(job, [reactor, reply, job](const std::vector<std::string>& reasons) {
      for (const std::string& reason : reasons) {
        reply->add_reason(reason);
      }
      reactor->Finish(reasons.empty() ? link::to_grpc(absl::NotFoundError(
                                            absl::StrCat("there is no job ", job)))
                                      : grpc::Status::OK);
    });
    return absl::OkStatus();
  });
}

}  // namespace bandsaw::coordinator
