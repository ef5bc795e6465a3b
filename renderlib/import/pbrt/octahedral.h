#pragma once

// Converts pbrt's environment images (an octahedral map in pbrt-v4, longitude and latitude in
// pbrt-v3) to our environment maps.

#include "renderlib/image/image.h"
#include "renderlib/math/transform.h"

namespace bandsaw::pbrt {

/// An image of all directions, in the space of its light.
struct Sky {
  const Image& image;
  /// True: the square of Clarberg's equal-area map of the octahedron (2008), as in pbrt-v4. False:
  /// longitude and latitude around z, as in pbrt-v3.
  bool is_octahedral = true;
};

/// Returns the position of a direction (a unit vector) in the equal-area octahedral image. The
/// position is in [0, 1]^2, rows from the top.
Vec2 octahedral_of(const Vec3& direction);

/// Returns the image as an environment map of Bandsaw, resampled with 2 x 2 bilinear samples per
/// pixel. `to_light` maps directions from the world to the light's space.
Image equirectangular(const Sky& sky, const Transform& to_light);

/// Returns the illuminance of a surface that faces +z in the light's space and is lit by the image
/// alone.
double illuminance_of(const Sky& sky);

}  // namespace bandsaw::pbrt
