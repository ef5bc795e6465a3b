#pragma once

// An evening sky that never was, all around: what the gallery's environments show.

#include <cstdint>

#include "renderlib/image/image.h"
#include "renderlib/math/vec.h"

namespace bandsaw::gallery {

/// Radiance from a unit direction: orange at the horizon, blue above, clouds of turbulence, dark
/// ground, and a sun of 3 degrees' radius at azimuth 40 degrees from +x towards +z, 25 degrees
/// high.
Rgb evening_sky(const Vec3& unit);

/// The same place after the sun has set: a glow at the horizon where it went down, deep blue above,
/// and a high cloud that still shines, as a soft light from the side.
Rgb dusk_sky(const Vec3& unit);

/// The same as equirectangular images, 2 rows wide; each texel the mean of 8 x 8 directions.
Image evening_sky_map(std::uint32_t rows);
Image dusk_sky_map(std::uint32_t rows);

/// The same as one side of a cube map: 0 to 5 are +x, -x, +y, -y, +z, -z, laid as
/// renderlib/light/environment.h says.
Image evening_sky_side(std::uint32_t face, std::uint32_t side);

}  // namespace bandsaw::gallery
