#pragma once

#include <string>

#include "absl/status/status.h"

namespace bandsaw::coordinator {

/// Whether HOST:PORT can be listened on now; gRPC itself does not say why it cannot.
/// FAILED_PRECONDITION: taken, not an address of this machine, or not allowed. INVALID_ARGUMENT:
/// not HOST:PORT.
absl::Status check_can_listen(const std::string& listen);

}  // namespace bandsaw::coordinator
