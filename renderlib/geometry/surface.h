#pragma once

// The surface at a hit, in world space, to full double precision, and the rays that leave it or
// lead to it.

#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

struct SurfacePoint {
  Vec3 position;  ///< on the primitive: from barycentrics, or projected back onto the sphere
  Vec3 geometric_normal;  ///< unit; points to the outside as geometry/shapes.h defines it (also in
                          ///< mirrored instances)
  Vec3 shading_normal;    ///< unit; interpolated if the mesh has normals, otherwise the geometric
                          ///< one; always in the hemisphere of the geometric one
  /// Spheres: as sphere_uv() (geometry/sphere_uv.h), i.e. u is 1/2 at +x and 3/4 at -z, and v is 0
  /// at the pole -y. Quads: the coordinates along their edges. Disks: the square around them, [0,
  /// 1]^2. Triangles: the weights of corners b and c. Meshes: their own uv; the weights if they
  /// have none.
  Vec2 uv;
  Vec2 uv2;              ///< second uv set of a mesh; uv if there is none
  Vec3 object_position;  ///< the position before the placement of a mesh or group; on spheres,
                         ///< relative to the centre
  Rgb color{1, 1, 1};    ///< interpolated vertex colour; white if there is none
  /// Directions in which u and v grow, of any length; zero unless set by add_uv_directions().
  Vec3 along_u;
  Vec3 along_v;
  Vec3 along_u2;  ///< as along_u and along_v, for uv2
  Vec3 along_v2;
  MaterialId material{};
  PrimitiveId id;
  /// True if an instance squashes space so much that rounding in the primitive's own space matters.
  bool squashed = false;
  /// Distance along the normal at which ray origins are certainly off the surface. It is 2^-40 of
  /// the largest number from which the position was computed, in the world or in the primitive's
  /// own space (README.md, "Squashed space"). If an instance squashes space, the distance also
  /// depends on how much the instance squashes along this normal.
  double offset = 0;
  /// Vector from the position to the origin of rays that leave outwards. Rays that leave inwards
  /// start at the position minus this vector. It is geometric_normal times `offset`, except if an
  /// instance squashes space. In squashed space that product could lead past the primitive, so
  /// `away` is perpendicular to the primitive in the primitive's own space.
  Vec3 away;
  double t = 0;     ///< Hit::t
  double time = 0;  ///< time of the ray that hit it; rays from here have the same time
};

/// Returns the geometric normal on the side to which `wo` points.
inline Vec3 facing_normal(const SurfacePoint& point, const Vec3& wo) {
  return dot(wo, point.geometric_normal) >= 0 ? point.geometric_normal : -point.geometric_normal;
}

/// Precomputes the normals of loose quads and triangles (24 bytes each), which surface_at() would
/// otherwise compute at each hit. The surfaces are the same to the bit. Quads and triangles MUST
/// NOT be added, removed or changed afterwards.
void prepare_surfaces(Geometry& geometry);

/// Returns the surface at a hit of `ray`. If `sphere_uv` is false, the uvs of spheres are zero,
/// which saves the computation of two angles.
SurfacePoint surface_at(const Geometry& geometry, const Ray& ray, const Hit& hit,
                        bool sphere_uv = true);

/// Sets along_u and along_v, or along_u2 and along_v2 if `second` is true. They stay zero if the
/// uvs of a mesh's triangle have no area.
void add_uv_directions(const Geometry& geometry, bool second, SurfacePoint& point);

/// Does the same as add_uv_directions(), but for every kind of shape the vectors have the lengths
/// of the derivatives dp/du and dp/dv in world space.
void add_uv_derivatives(const Geometry& geometry, bool second, SurfacePoint& point);

/// Returns the distance along `ray`, whose direction is a unit vector, to the surface that it hit.
/// In squashed space a rounded position is on its primitive, but its distance from the ray may
/// exceed the thickness of the primitive. Therefore t is used in squashed space and not the
/// position.
inline double distance_along(const Ray& ray, const SurfacePoint& hit) {
  return hit.squashed ? hit.t : length(hit.position - ray.origin);
}

/// Returns a ray that leaves the surface. The ray starts off the surface on the side of
/// `direction`, and it cannot hit the same primitive again if the primitive is flat. (Inline, so
/// that the caller has the ray in registers.)
inline Ray spawn_ray(const SurfacePoint& from, const Vec3& direction, double t_max = kInfinity) {
  const bool inwards = dot(direction, from.geometric_normal) < 0;
  return {inwards ? from.position - from.away : from.position + from.away, direction, t_max,
          from.id, from.time};
}

/// Returns a shadow ray from `from` to `target`. Its direction is the vector to the target, so t =
/// 1 is the target. The ray ends before the target by the length `target_offset`
/// (SurfacePoint::offset of the target, or 0 for a point in space).
Ray spawn_ray_to(const SurfacePoint& from, const Vec3& target, double target_offset);

/// Returns a shadow ray to another surface. The ray ends beside that surface, on the side that
/// faces `from`, so that the surface never occludes the ray, even if the surface is seen edge-on.
Ray spawn_ray_to(const SurfacePoint& from, const SurfacePoint& target);

/// Returns SurfacePoint::offset of a point at `position` on a primitive of no instance. `size` is
/// the largest number from which the position was computed.
double surface_offset(const Vec3& position, double size);

}  // namespace bandsaw
