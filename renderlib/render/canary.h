#pragma once

// A small render that every program makes at start: machines whose hash differs do not render the
// same pixels.

#include <cstdint>

namespace bandsaw {

/// The hash of the sums of a built-in scene that uses every feature, and of the elementary
/// functions. A few milliseconds.
std::uint64_t canary();

}  // namespace bandsaw
