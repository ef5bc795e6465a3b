#pragma once

// The canary: a small render that every program performs at start, and whose pixels are hashed. Two
// machines with different hashes would not render the same pixels. So a coordinator refuses a
// worker whose hash is not the coordinator's.

#include <cstdint>

namespace bandsaw {

struct Kernel;  // renderlib/render/kernel.h

/// Returns a hash of pixel sums and of values of the elementary functions, as `kernel` computes
/// them. The pixels show built-in scenes with every kind of shape, light and camera, nearly every
/// kind of material and texture, and media. Takes a few milliseconds. `kernel` is the render code
/// for one instruction set, one of kernels(); nullptr selects the first of them.
std::uint64_t canary(const Kernel* kernel = nullptr);

}  // namespace bandsaw
