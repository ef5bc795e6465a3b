#pragma once

// Smaller pictures, for people to look at.

#include <cstdint>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Means of cells of across x down pixels, both >= 1; those at the right and lower edge are of what
/// is left.
Image shrunk(const Image& image, std::uint32_t across, std::uint32_t down);

}  // namespace bandsaw
