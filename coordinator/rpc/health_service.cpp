#include "coordinator/rpc/health_service.h"

#include "coordinator/rpc/streams.h"
#include "proto/farm.grpc.pb.h"

namespace bandsaw::coordinator {

grpc::ServerUnaryReactor* HealthService::Check(grpc::CallbackServerContext* context,
                                               const grpc::health::v1::HealthCheckRequest* request,
                                               grpc::health::v1::HealthCheckResponse* reply) {
  const std::string& service = request->service();
  if (!service.empty() && service != farm::Farm::service_full_name() &&
      service != farm::Work::service_full_name()) {
    return finished(context, absl::NotFoundError("there is no such service here"));
  }
  reply->set_status(grpc::health::v1::HealthCheckResponse::SERVING);
  return finished(context, absl::OkStatus());
}

}  // namespace bandsaw::coordinator
