#pragma once

#include <grpcpp/grpcpp.h>

namespace bandsaw::coordinator {

/// The server tells whoever asks which services, calls and messages it has (gRPC server
/// reflection), or does not. What libgrpc++_reflection does by being linked is undone: it would
/// tell in any case.
void set_reflection(grpc::ServerBuilder& builder, bool wanted);

}  // namespace bandsaw::coordinator
