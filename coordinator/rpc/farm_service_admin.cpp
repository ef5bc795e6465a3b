// RPCs for administration: logs, quarantine, description of the coordinator, new secrets.

#include <algorithm>
#include <chrono>

#include "coordinator/rpc/convert.h"
#include "coordinator/rpc/gate.h"
#include "coordinator/rpc/services.h"
#include "proto/wire/versions.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/pixel_version.h"

namespace bandsaw::coordinator {
namespace {

using Unary = grpc::ServerUnaryReactor;

double unix_seconds() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

absl::StatusOr<std::string> FarmService::worker_named(const grpc::CallbackServerContext& context,
                                                      const std::string& name) const {
  RETURN_IF_ERROR(deps_.gate.check(context, link::Role::kFarm));
  return reason_field("worker", name);
}

Unary* FarmService::Logs(grpc::CallbackServerContext* context, const farm::LogsRequest* request,
                         farm::LogsReply* reply) {
  const absl::StatusOr<std::string> worker = worker_named(*context, request->worker());
  if (!worker.ok()) {
    return finished(context, worker.status());
  }
  Unary* reactor = context->DefaultReactor();
  deps_.engine.logs(*worker, [reactor, reply](absl::StatusOr<std::vector<std::string>> lines) {
    if (lines.ok()) {
      for (std::string& line : *lines) {
        reply->add_line(std::move(line));
      }
    }
    reactor->Finish(link::to_grpc(lines.status()));
  });
  return reactor;
}

Unary* FarmService::Quarantine(grpc::CallbackServerContext* context,
                               const farm::QuarantineRequest* request, farm::QuarantineReply*) {
  const absl::StatusOr<std::string> worker = worker_named(*context, request->worker());
  if (!worker.ok()) {
    return finished(context, worker.status());
  }
  Unary* reactor = context->DefaultReactor();
  deps_.engine.quarantine(*worker, request->lift(), [reactor](const absl::Status& status) {
    reactor->Finish(link::to_grpc(status));
  });
  return reactor;
}

Unary* FarmService::About(grpc::CallbackServerContext* context, const farm::AboutRequest*,
                          farm::AboutReply* reply) {
  if (const auto status = deps_.gate.check_any(*context); !status.ok()) {
    return finished(context, status);
  }
  Unary* reactor = context->DefaultReactor();
  deps_.files.post([this, reactor, reply] {
    reply->set_version(BANDSAW_VERSION);
    reply->set_protocol(wire::kProtocol);
    reply->set_pixel_version(kPixelVersion);
    reply->set_free_bytes(deps_.engine.free_bytes());
    deps_.engine.workers([reactor, reply](const std::vector<WorkerView>& workers) {
      reply->set_workers(static_cast<std::uint32_t>(
          std::count_if(workers.begin(), workers.end(), [](const WorkerView& worker) {
            return worker.state != "lost" && worker.state != "refused" &&
                   worker.state != "quarantined";
          })));
      reply->set_unix_s(unix_seconds());
      reactor->Finish(grpc::Status::OK);
    });
  });
  return reactor;
}

Unary* FarmService::RotateSecret(grpc::CallbackServerContext* context,
                                 const farm::RotateSecretRequest* request,
                                 farm::RotateSecretReply* reply) {
  if (const auto status = deps_.gate.check(*context, link::Role::kFarm); !status.ok()) {
    return finished(context, status);
  }
  if (request->role() != farm::SECRET_ROLE_WORKER && request->role() != farm::SECRET_ROLE_FARM) {
    return finished(context, absl::InvalidArgumentError("role: must be worker or farm"));
  }
  const auto role =
      request->role() == farm::SECRET_ROLE_WORKER ? link::Role::kWorker : link::Role::kFarm;
  Unary* reactor = context->DefaultReactor();
  deps_.files.post([this, reactor, reply, role] {
    const absl::StatusOr<std::string> file = deps_.gate.rotate(role);
    if (file.ok()) {
      reply->set_join_file(*file);
      deps_.streams.stop_those_of(role, void_secret());
    }
    reactor->Finish(link::to_grpc(file.status()));
  });
  return reactor;
}

}  // namespace bandsaw::coordinator
