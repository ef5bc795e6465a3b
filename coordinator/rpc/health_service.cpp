#include "coordinator/rpc/health_service.h"

#include "proto/farm.grpc.pb.h"
#include "proto/link/channel.h"

namespace bandsaw::coordinator {

grpc::ServerUnaryReactor* HealthService::Check(grpc::CallbackServerContext* context,
                                               const grpc::health::v1::HealthCheckRequest* request,
                                               grpc::health::v1::HealthCheckResponse* reply) {
  grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
  const std::string& service = request->service();
  if (!service.empty() && service != farm::Farm::service_full_name() &&
      service != farm::Work::service_full_name()) {
    reactor->Finish(link::to_grpc(absl::NotFoundError("there is no such service here")));
    return reactor;
  }
  reply->set_status(grpc::health::v1::HealthCheckResponse::SERVING);
  reactor->Finish(grpc::Status::OK);
  return reactor;
}

}  // namespace bandsaw::coordinator
