#pragma once

// The canary: a small render that every program performs at start. Machines whose hashes differ do
// not render the same pixels.

#include <cstdint>

namespace bandsaw {

struct Kernel;  // renderlib/render/kernel.h

/// Returns a hash of the pixel sums of built-in scenes that use every feature, and of the
/// elementary functions, as `kernel` computes them. Takes a few milliseconds. `kernel` is one of
/// kernels(); nullptr selects the first of them.
std::uint64_t canary(const Kernel* kernel = nullptr);

}  // namespace bandsaw
