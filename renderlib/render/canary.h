#pragma once

// The canary: a small render that every program performs at start. Machines whose hashes of it
// differ would not render the same pixels, so a coordinator refuses a worker whose hash differs.

#include <cstdint>

namespace bandsaw {

struct Kernel;  // renderlib/render/kernel.h

/// Returns a hash of pixel sums and of values of the elementary functions, as `kernel` computes
/// them. The pixels show built-in scenes with every kind of shape, light and camera, nearly every
/// kind of material and texture, and media. Takes a few milliseconds. `kernel` is one of kernels();
/// nullptr selects the first of them.
std::uint64_t canary(const Kernel* kernel = nullptr);

}  // namespace bandsaw
