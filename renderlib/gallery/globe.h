#pragma once

// A planet that never was, as a map: what the study's texture scenes wrap around a sphere.

#include <cstdint>
#include <vector>

#include "renderlib/base/pool.h"

namespace bandsaw::gallery {

/// sRGB codes of an equirectangular map of 2 rows x rows texels, three a texel, north on top.
/// Continents, shelves, deserts, mountains and ice are gradient noise on the unit sphere: the same
/// planet at every size, with finer coasts the more rows there are. 8 <= rows <= 8192.
std::vector<std::uint8_t> globe_map(std::uint32_t rows, Pool& pool);

}  // namespace bandsaw::gallery
