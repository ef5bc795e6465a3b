#pragma once

// Two invented skies, of an evening and of dusk, for the gallery's environments.

#include <cstdint>

#include "renderlib/image/image.h"
#include "renderlib/math/vec.h"

namespace bandsaw::gallery {

/// Returns the radiance from a unit direction: orange at the horizon, blue above, clouds of
/// turbulence, dark ground, and a sun of 3 degrees' radius at azimuth 40 degrees from +x towards
/// +z, 25 degrees high.
Rgb evening_sky(const Vec3& unit);

/// Returns the radiance from a unit direction after sunset: a glow at the horizon, deep blue above,
/// and a high bright cloud, which is a soft light from the side.
Rgb dusk_sky(const Vec3& unit);

/// These functions return the skies as equirectangular images of 2 * rows x rows texels; each texel
/// is the mean of 8 x 8 directions.
Image evening_sky_map(std::uint32_t rows);
Image dusk_sky_map(std::uint32_t rows);

/// Returns the evening sky as one face of a cube map with `side` x `side` texels. Faces 0 to 5 are
/// +x, -x, +y, -y, +z, -z, oriented as in renderlib/light/environment.h.
Image evening_sky_side(std::uint32_t face, std::uint32_t side);

}  // namespace bandsaw::gallery
