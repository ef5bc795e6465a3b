// RPCs that control or explain one job.

#include "absl/strings/str_cat.h"
#include "coordinator/rpc/convert.h"
#include "coordinator/rpc/gate.h"
#include "coordinator/rpc/services.h"

namespace bandsaw::coordinator {
namespace {

using Unary = grpc::ServerUnaryReactor;

/// Runs a command on the engine and replies with the job's status after it. `tell` is called with
/// the callback that receives the job.
template <class Tell>
Unary* told(const ServiceDependencies& deps, grpc::CallbackServerContext* context,
            farm::JobStatus* reply, Tell tell) {
  if (const auto status = deps.gate.check(*context, link::Role::kFarm); !status.ok()) {
    return finished(context, status);
  }
  Unary* reactor = context->DefaultReactor();
  tell([reactor, reply](const absl::StatusOr<JobView>& job) {
    if (job.ok()) {
      *reply = to_message(*job);
    }
    reactor->Finish(link::to_grpc(job.status()));
  });
  return reactor;
}

}  // namespace

Unary* FarmService::Cancel(grpc::CallbackServerContext* context, const farm::CancelRequest* request,
                           farm::JobStatus* reply) {
  return told(deps_, context, reply,
              [&](auto answer) { deps_.engine.cancel(request->job(), answer); });
}

Unary* FarmService::Pause(grpc::CallbackServerContext* context, const farm::PauseRequest* request,
                          farm::JobStatus* reply) {
  return told(deps_, context, reply,
              [&](auto answer) { deps_.engine.pause(request->job(), answer); });
}

Unary* FarmService::Resume(grpc::CallbackServerContext* context, const farm::ResumeRequest* request,
                           farm::JobStatus* reply) {
  return told(deps_, context, reply,
              [&](auto answer) { deps_.engine.resume(request->job(), answer); });
}

Unary* FarmService::SetPriority(grpc::CallbackServerContext* context,
                                const farm::SetPriorityRequest* request, farm::JobStatus* reply) {
  return told(deps_, context, reply, [&](auto answer) {
    deps_.engine.set_priority(request->job(), request->priority(), answer);
  });
}

Unary* FarmService::Why(grpc::CallbackServerContext* context, const farm::WhyRequest* request,
                        farm::WhyReply* reply) {
  if (const auto status = deps_.gate.check(*context, link::Role::kFarm); !status.ok()) {
    return finished(context, status);
  }
  Unary* reactor = context->DefaultReactor();
  const JobId job = request->job();
  deps_.engine.why(job, [reactor, reply, job](const std::vector<std::string>& reasons) {
    for (const std::string& reason : reasons) {
      reply->add_reason(reason);
    }
    reactor->Finish(reasons.empty()
                        ? link::to_grpc(absl::NotFoundError(absl::StrCat("there is no job ", job)))
                        : grpc::Status::OK);
  });
  return reactor;
}

}  // namespace bandsaw::coordinator
