#pragma once

#include <grpcpp/grpcpp.h>

namespace bandsaw::coordinator {

/// Enables or disables gRPC server reflection, which lists services, calls and messages to any
/// client. libgrpc++_reflection enables it by being linked; this function removes that plugin.
void set_reflection(grpc::ServerBuilder& builder, bool wanted);

}  // namespace bandsaw::coordinator
