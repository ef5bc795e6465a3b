#pragma once

// The invariants of the scheduler's state, which the tests check after every step; README.md lists
// them.

#include <optional>
#include <string>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

/// Returns a sentence about the first invariant that does not hold; std::nullopt: all hold. Between
/// two steps, all invariants must hold.
std::optional<std::string> broken_invariant(const Context& context);

}  // namespace bandsaw::coordinator
