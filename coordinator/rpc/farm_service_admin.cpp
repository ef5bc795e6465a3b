// Implements the calls of the service Farm for administration: logs, quarantine, description of the
// coordinator, new secrets, the link by which browsers join the farm.

#include <algorithm>
#include <chrono>

#include "coordinator/rpc/checked_messages.h"
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

/// Revokes the link for browsers if the request says so. Otherwise returns the link. If there is no
/// link, makes one. If the request has a duration, the link ends after this duration. Waits for the
/// disk.
absl::StatusOr<farm::BrowserLinkReply> browser_link(BrowserAccess& browsers,
                                                    const farm::BrowserLinkRequest& request) {
  farm::BrowserLinkReply reply;
  if (request.revoke()) {
    RETURN_IF_ERROR(browsers.revoke());
    return reply;
  }
  std::optional<BrowserAccess::Link> link = browsers.present();
  if (!link || request.seconds() != 0) {
    ASSIGN_OR_RETURN(link, browsers.make(request.seconds() == 0 ? BrowserAccess::kStandardSeconds
                                                                : request.seconds()));
  }
  reply.set_url(link->url);
  reply.set_left_s(link->left_s);
  return reply;
}

}  // namespace

Unary* FarmService::Logs(grpc::CallbackServerContext* context, const farm::LogsRequest* request,
                         farm::LogsReply* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) -> absl::Status {
    ASSIGN_OR_RETURN(const std::string worker, reason_field("worker", request->worker()));
    deps_.engine.logs(worker, [reactor, reply](absl::StatusOr<std::vector<std::string>> lines) {
      if (lines.ok()) {
        for (std::string& line : *lines) {
          reply->add_line(std::move(line));
        }
      }
      reactor->Finish(link::to_grpc(lines.status()));
    });
    return absl::OkStatus();
  });
}

Unary* FarmService::Quarantine(grpc::CallbackServerContext* context,
                               const farm::QuarantineRequest* request, farm::QuarantineReply*) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) -> absl::Status {
    ASSIGN_OR_RETURN(const std::string worker, reason_field("worker", request->worker()));
    deps_.engine.quarantine(worker, request->lift(), [reactor](const absl::Status& status) {
      reactor->Finish(link::to_grpc(status));
    });
    return absl::OkStatus();
  });
}

Unary* FarmService::About(grpc::CallbackServerContext* context, const farm::AboutRequest*,
                          farm::AboutReply* reply) {
  return unary(deps_, *context, std::nullopt, [&](Unary* reactor) {
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
    return absl::OkStatus();
  });
}

Unary* FarmService::RotateSecret(grpc::CallbackServerContext* context,
                                 const farm::RotateSecretRequest* request,
                                 farm::RotateSecretReply* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) -> absl::Status {
    if (request->role() != farm::SECRET_ROLE_WORKER && request->role() != farm::SECRET_ROLE_FARM) {
      return absl::InvalidArgumentError("role: must be worker or farm");
    }
    const auto role =
        request->role() == farm::SECRET_ROLE_WORKER ? link::Role::kWorker : link::Role::kFarm;
    deps_.files.post([this, reactor, reply, role] {
      const absl::StatusOr<RenewedSecret> renewed = deps_.gate.rotate(role);
      if (!renewed.ok()) {
        reactor->Finish(link::to_grpc(renewed.status()));
        return;
      }
      deps_.streams.stop_those_of(role, void_secret());
      reply->set_join_file(renewed->join_file);
      reactor->Finish(link::to_grpc(renewed->written));
    });
    return absl::OkStatus();
  });
}

Unary* FarmService::BrowserLink(grpc::CallbackServerContext* context,
                                const farm::BrowserLinkRequest* request,
                                farm::BrowserLinkReply* reply) {
  return unary(deps_, *context, link::Role::kFarm, [&](Unary* reactor) -> absl::Status {
    if (deps_.browsers == nullptr) {
      return absl::FailedPreconditionError("this coordinator admits no browsers");
    }
    if (request->revoke() && request->seconds() != 0) {
      return absl::InvalidArgumentError("seconds: must be 0 if the link is revoked");
    }
    deps_.files.post([this, reactor, reply, wanted = *request] {
      const absl::StatusOr<farm::BrowserLinkReply> done = browser_link(*deps_.browsers, wanted);
      if (done.ok()) {
        *reply = *done;
      }
      reactor->Finish(link::to_grpc(done.status()));
    });
    return absl::OkStatus();
  });
}

}  // namespace bandsaw::coordinator
