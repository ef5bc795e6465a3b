#pragma once

#include "absl/status/status.h"

namespace bandsaw {

/// The seccomp part of confine_this_process; "no new privileges" has been set.
absl::Status forbid_system_calls();

}  // namespace bandsaw
