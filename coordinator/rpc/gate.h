#pragma once

// Who may call: the secret of each call, checked before anything else of it is looked at.

#include <grpcpp/grpcpp.h>

#include "absl/status/status.h"
#include "proto/link/identity.h"

namespace bandsaw::coordinator {

/// UNAUTHENTICATED: no or wrong secret. PERMISSION_DENIED: the other role's.
absl::Status check_caller(const grpc::CallbackServerContext& context,
                          const link::Identity& identity, link::Role needed);

}  // namespace bandsaw::coordinator
