#pragma once

// A record of the training of path guiding: light that arrived at a point of a surface. `integrate`
// makes records (training_paths.h, training_photons.h); GuidingField is fitted to them.

#include <cstdint>

#include "renderlib/math/float3.h"

namespace bandsaw {

/// Single precision is enough for a record, because fields only choose directions.
struct GuidingRecord {
  enum class Kind : std::uint8_t {
    /// A vertex of a path from the camera: `weight` estimates the irradiance of the vertex.
    kPath,
    /// A photon: `weight` is its power, so that the sum over an area is the power that arrives.
    kPhoton,
  };
  Float3 position;   ///< point on the surface that receives the light
  Float3 normal;     ///< unit, on the side that receives it
  Float3 source;     ///< where the light comes from; very far away for light of the background
  float weight = 0;  ///< >= 0, finite; 0: the path found no light
  Kind kind = Kind::kPath;
  /// For a photon that only mirrors and smooth glass have scattered, this is the solid angle of its
  /// light in steradians, as seen from the first caster. It is 0 for other photons and for delta
  /// lights.
  float solid_angle = 0;
};

/// Returns the number in [0, 6) of the axis direction that is closest to `normal`: +x, -x, +y, …
inline std::uint32_t side_of(const Vec3& normal) {
  const double x = std::abs(normal.x);
  const double y = std::abs(normal.y);
  const double z = std::abs(normal.z);
  const std::uint32_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  return 2 * axis + (normal[static_cast<int>(axis)] < 0 ? 1 : 0);
}

}  // namespace bandsaw
