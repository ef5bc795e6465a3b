#pragma once

// A ray and what it met. Distances t are in units of |direction|; direction need not be a unit vector.

#include <cstddef>
#include <cstdint>

#include "renderlib/math/constants.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Names a surface element over the whole scene (geometry/shapes.h, Geometry).
struct PrimitiveId {
  std::uint32_t instance = 0xffffffffu;
  std::uint32_t primitive = 0xffffffffu;
  friend constexpr auto operator<=>(const PrimitiveId&, const PrimitiveId&) = default;
};

inline constexpr PrimitiveId kNoPrimitive{};

struct Ray {
  Vec3 origin;
  Vec3 direction;
  double t_max = kInfinity;  ///< hits have 0 < t < t_max
  /// A flat primitive that the ray starts on and cannot hit again. For a sphere: its near root is not taken as a hit.
  PrimitiveId from = kNoPrimitive;
  double time = 0;  ///< when it is: moving things are where they are then
};

/// Numbers of a triangle that a tree keeps lie this far apart (Hit::corners).
inline constexpr std::size_t kCornerStride = 8;

/// The closest hit: the lexicographically lowest (t, instance, primitive), whatever tree found it.
struct Hit {
  double t = kInfinity;
  PrimitiveId id = kNoPrimitive;
  /// Triangles: barycentric weights of b and c. Quads: the coordinates along u and v. Spheres: unused.
  double u = 0;
  double v = 0;
  /// Of a mesh's triangle, where its tree keeps it, near at hand: component k of corner c at
  /// [(3 c + k) kCornerStride], the mesh's own bits. Null: only the mesh has it.
  const float* corners = nullptr;

  explicit operator bool() const { return id != kNoPrimitive; }
};

}  // namespace bandsaw
