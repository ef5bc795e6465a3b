#pragma once

// Whether the coordinator serves, for probes: proto/health.proto.

#include <grpcpp/grpcpp.h>

#include "proto/health.grpc.pb.h"

namespace bandsaw::coordinator {

/// Answers whoever asks: it says only that the port is served, which the open port says too. That
/// it answers at all means that the engine has read its journal.
class HealthService final : public grpc::health::v1::Health::CallbackService {
 public:
  grpc::ServerUnaryReactor* Check(grpc::CallbackServerContext* context,
                                  const grpc::health::v1::HealthCheckRequest* request,
                                  grpc::health::v1::HealthCheckResponse* reply) override;
};

}  // namespace bandsaw::coordinator
