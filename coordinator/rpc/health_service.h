#pragma once

// Health check for probes: proto/health.proto.

#include <grpcpp/grpcpp.h>

#include "proto/health.grpc.pb.h"

namespace bandsaw::coordinator {

/// Answers without a secret: the reply reveals only that the port is served, as the open port does.
/// The service is registered after the engine has replayed its journal, so an answer implies that.
class HealthService final : public grpc::health::v1::Health::CallbackService {
 public:
  grpc::ServerUnaryReactor* Check(grpc::CallbackServerContext* context,
                                  const grpc::health::v1::HealthCheckRequest* request,
                                  grpc::health::v1::HealthCheckResponse* reply) override;
};

}  // namespace bandsaw::coordinator
