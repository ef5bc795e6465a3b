#pragma once

// Downscaling of images for display, in the terminal and in the dashboard.

#include <cstdint>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Returns the means of cells of `across` x `down` pixels, both >= 1. Cells at the right and lower
/// edge may be smaller.
Image shrunk(const Image& image, std::uint32_t across, std::uint32_t down);

}  // namespace bandsaw
