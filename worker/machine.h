#pragma once

// What a worker can say of the machine and the build it runs on.

#include <string>

#include "absl/status/status.h"
#include "renderlib/render/kernel.h"

namespace bandsaw::worker {

std::string host_name();

/// Version, compiler, kernel, CPU: for people, never compared.
std::string build_description(const Kernel& kernel);

/// $XDG_CACHE_HOME/bandsaw/blobs, or ~/.cache/bandsaw/blobs: all workers of one user share it.
/// Empty: neither is known.
std::string default_cache_folder();

/// FAILED_PRECONDITION: the floating-point unit is not in its default mode (round to nearest,
/// nothing flushed to zero), which would change pixels.
absl::Status check_machine();

}  // namespace bandsaw::worker
