#pragma once

// A small render that every program makes at start: machines whose hash differs do not render the
// same pixels.

#include <cstdint>

namespace bandsaw {

struct Kernel;  // renderlib/render/kernel.h

/// The hash of the sums of a built-in scene that uses every feature, and of the elementary
/// functions, as `kernel` computes them. A few milliseconds. `kernel`: one of kernels(); null: the
/// first of them.
std::uint64_t canary(const Kernel* kernel = nullptr);

}  // namespace bandsaw
