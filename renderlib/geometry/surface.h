#pragma once

// The surface at a hit, in world space, to full double precision.

#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

struct SurfacePoint {
  Vec3 position;  ///< on the primitive: from barycentrics, or projected back onto the sphere
  Vec3 geometric_normal;  ///< unit; to the outside as geometry/shapes.h defines it (mirrored
                          ///< instances keep it outside)
  Vec3 shading_normal;  ///< unit; interpolated where the mesh has normals, else the geometric one;
                        ///< same hemisphere
  /// Spheres: as a globe with the seam at -x and v = 0 at the pole -y, u in [0, 1), u = 1/2 at +x,
  /// 3/4 at -z. Quads: (a, b). Disks: the square around them. Triangles: the weights of b and c.
  /// Meshes: their own uv, else weights.
  Vec2 uv;
  Vec2 uv2;              ///< a mesh's second set; uv where there is none
  Vec3 object_position;  ///< meshes and groups: before their placement; spheres: from their
                         ///< centre; else the position
  Rgb color{1, 1, 1};    ///< of the vertices, interpolated; white where there is none
  /// The directions in which the uvs grow, of any length; zero unless set by add_uv_directions.
  Vec3 along_u;
  Vec3 along_v;
  Vec3 along_u2;  ///< those of uv2
  Vec3 along_v2;
  MaterialId material{};
  PrimitiveId id;
  /// Whether an instance squashes space so much that rounding in the primitive's own space counts.
  bool squashed = false;
  /// How far apart ray origins and surface must lie along the normal to be told apart: 2^-40
  /// max(|position|, size of the primitive), in the larger of object and world space scale. Where
  /// an instance squashes space it depends on how far it squashes along this normal.
  double offset = 0;
  /// From the position to where rays that leave outwards begin; those that leave inwards begin at
  /// the other side. geometric_normal times `offset`, but where an instance squashes space: there
  /// that may lead past the primitive, and this is at a right angle to it in its own space.
  Vec3 away;
  double t = 0;     ///< Hit::t
  double time = 0;  ///< of the ray that met it; rays from here are at that time too
};

/// Makes ready what surface_at would find anew at each hit, 24 bytes a loose quad or triangle: the
/// surfaces are the same to the bit. No quad or triangle MUST come, go or change after.
void prepare_surfaces(Geometry& geometry);

/// `sphere_uv`: false where nobody looks at the uvs of spheres, which are zero then: their angles
/// are much of the work.
SurfacePoint surface_at(const Geometry& geometry, const Ray& ray, const Hit& hit,
                        bool sphere_uv = true);

/// Sets along_u and along_v, or those of the second set; they stay zero where the uvs of a triangle
/// have no area.
void add_uv_directions(const Geometry& geometry, bool second, SurfacePoint& point);

/// How far along `ray`, whose direction is a unit vector, the surface is that it has met. A
/// position that was rounded in squashed space is on its primitive, but may lie further beside the
/// ray than the primitive is thick: not it tells the distance there.
inline double distance_along(const Ray& ray, const SurfacePoint& met) {
  return met.squashed ? met.t : length(met.position - ray.origin);
}

/// A ray that leaves the surface: starts off it on the side of `direction` and cannot hit the flat
/// primitive again. (Here, so that what waits for the ray has it in registers.)
inline Ray spawn_ray(const SurfacePoint& from, const Vec3& direction, double t_max = kInfinity) {
  const bool inwards = dot(direction, from.geometric_normal) < 0;
  return {inwards ? from.position - from.away : from.position + from.away, direction, t_max,
          from.id, from.time};
}

/// A ray from `from` to `target`, for asking whether anything lies between; t is in (0, 1), ends
/// short of the target surface by `target_offset` (its SurfacePoint::offset; 0 for a point in
/// space).
Ray spawn_ray_to(const SurfacePoint& from, const Vec3& target, double target_offset);

/// The same to another surface: ends off it, on the side that faces `from`, so that
/// the surface itself is never between, however edge-on it is seen.
Ray spawn_ray_to(const SurfacePoint& from, const SurfacePoint& target);

/// SurfacePoint::offset of a point at `position` on a primitive of `size`, in world space without
/// instances.
double surface_offset(const Vec3& position, double size);

}  // namespace bandsaw
