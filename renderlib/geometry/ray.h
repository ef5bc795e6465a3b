#pragma once

// Rays and hits. Distances t are in units of |direction|; the direction can have any length.

#include <cstddef>
#include <cstdint>

#include "renderlib/math/constants.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Identifies a primitive of the scene. Instance 0 stands for the loose shapes of the world (shapes
/// of no mesh and no group), instance i + 1 for Geometry::instances[i]. `primitive` is the number
/// of a triangle in the instance's mesh, or of a loose shape in the world or in the instance's
/// group. Loose shapes are numbered in the order spheres, quads, triangles, disks.
struct PrimitiveId {
  std::uint32_t instance = 0xffffffffu;
  std::uint32_t primitive = 0xffffffffu;
  friend constexpr auto operator<=>(const PrimitiveId&, const PrimitiveId&) = default;
};

inline constexpr PrimitiveId kNoPrimitive{};

struct Ray {
  Vec3 origin;
  Vec3 direction;
  double t_max = kInfinity;  ///< hits satisfy 0 < t < t_max
  /// The primitive on which the ray starts. A flat primitive is not hit again. On a sphere, the
  /// intersection with the smaller t is not a hit.
  PrimitiveId from = kNoPrimitive;
  double time = 0;  ///< moving instances are placed at this time
};

/// The BVH stores the triangles of a leaf in packs of eight. The numbers of the eight triangles are
/// interleaved, so consecutive numbers of one triangle are kCornerStride floats apart
/// (Hit::corners).
inline constexpr std::size_t kCornerStride = 8;

/// The closest hit: the lexicographically lowest (t, instance, primitive), independent of the BVH.
struct Hit {
  double t = kInfinity;
  PrimitiveId id = kNoPrimitive;
  /// Triangles: barycentric weights of b and c. Quads: coordinates along u and v. Disks:
  /// coordinates along the axes, in radii. Spheres: unused.
  double u = 0;
  double v = 0;
  /// For a triangle of a mesh, the corners in the BVH's pack: component k of corner c is at [(3 c +
  /// k) kCornerStride], with the mesh's own bits. Null for other primitives, for meshes that
  /// deform, and in hits that come from no BVH.
  const float* corners = nullptr;

  explicit operator bool() const { return id != kNoPrimitive; }
};

}  // namespace bandsaw
