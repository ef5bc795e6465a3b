#pragma once

// A map of an invented planet. The scenes gallery/study/texture_* wrap the map around a sphere.

#include <cstdint>
#include <vector>

#include "renderlib/base/pool.h"

namespace bandsaw::gallery {

/// Returns an equirectangular map of 2 rows x rows texels, three sRGB codes for each, with north on
/// top. Continents, shelves, deserts, mountains and ice are gradient noise on the unit sphere, so
/// the planet is the same at every size of the map, and more rows give finer coasts. `rows` MUST be
/// in [8, 8192].
std::vector<std::uint8_t> globe_map(std::uint32_t rows, Pool& pool);

}  // namespace bandsaw::gallery
