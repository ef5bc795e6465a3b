#pragma once

#include <string>

#include "absl/status/status.h"

namespace bandsaw::coordinator {

/// Checks that the coordinator can listen on `listen`, which has the form HOST:PORT. gRPC itself
/// does not report why it cannot listen. FAILED_PRECONDITION: the port is taken or not allowed, or
/// the host is not an address of this machine. INVALID_ARGUMENT: `listen` does not have the form
/// HOST:PORT.
absl::Status check_can_listen(const std::string& listen);

}  // namespace bandsaw::coordinator
