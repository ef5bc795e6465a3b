#pragma once

// Compares Accel, the renderer's BVH, with ReferenceAccel (brute force, or a simple BVH in double)
// on the same rays, for tests.

#include <gtest/gtest.h>

#include "renderlib/accel/accel.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/reference_accel.h"

namespace bandsaw::test {

inline bool same(const Hit& a, const Hit& b) {
  return a.t == b.t && a.id == b.id && a.u == b.u && a.v == b.v;
}

/// Returns a scene of one mesh with an identity placement.
inline Geometry scene_of(Mesh mesh) {
  Geometry geometry;
  geometry.meshes.push_back(std::move(mesh));
  geometry.instances.push_back({MeshId{0}, MaterialId{0}, {}});
  return geometry;
}

struct Agreement {
  int rays = 0;
  int hits = 0;  ///< number of rays that hit something in the reference
  /// Number of rays for which Accel found a hit with another t, id, u or v, or for which occluded()
  /// returned another result.
  int different = 0;
};

/// Traces `count` rays, which next() returns. Each ray that hits something is traced twice more:
/// first with its end at or near the hit, then with its origin at the hit. The first difference
/// makes the test fail.
template <class Next>
Agreement compare(const Accel& accel, const ReferenceAccel& reference, int count, Next&& next) {
  Agreement result;
  const auto shoot = [&](const Ray& ray) {
    const Hit hit = reference.closest(ray);
    const Hit found = accel.closest(ray);
    ++result.rays;
    result.hits += hit ? 1 : 0;
    if (!same(hit, found) || accel.occluded(ray) != static_cast<bool>(hit)) {
      if (result.different++ == 0) {
        ADD_FAILURE() << "expected t " << hit.t << " and primitive " << hit.id.instance << ":"
                      << hit.id.primitive << ", but found t " << found.t << " and primitive "
                      << found.id.instance << ":" << found.id.primitive << "; occluded() returned "
                      << accel.occluded(ray);
      }
    }
    return hit;
  };
  for (int i = 0; i < count; ++i) {
    Ray ray = next();
    const Hit hit = shoot(ray);
    if (hit) {
      ray.t_max = i % 3 == 0 ? hit.t : i % 3 == 1 ? hit.t * (1 + 0x1p-52) : hit.t * 0.999;
      shoot(ray);
      ray = {ray.origin + hit.t * ray.direction, ray.direction, kInfinity, hit.id};
      shoot(ray);
    }
  }
  return result;
}

/// Returns the bounding box of all finite vertices.
inline Box box_of(const Mesh& mesh) {
  Box box;
  for (const auto& p : mesh.positions) {
    if (is_finite(Vec3{p[0], p[1], p[2]})) {
      box.add({p[0], p[1], p[2]});
    }
  }
  return box;
}

/// Returns a random point of the box.
inline Vec3 random_point_in(const Box& box, Random& random) {
  const Vec3 p = random_point(random);
  const Vec3 half = 0.5 * (box.hi - box.lo);
  const Vec3 middle = box.lo + half;
  return middle + Vec3{p.x * half.x, p.y * half.y, p.z * half.z};
}

/// Returns a ray that starts in or around `box`, the bounding box of the mesh. It aims at a corner,
/// an edge or a face of the mesh, or at any point of the box. The length of the ray's direction is
/// the distance from the origin to this target, or 2^-37 of the distance.
inline Ray aimed_ray(const Mesh& mesh, const Box& box, Random& random) {
  const Box around = {box.lo * 2 - box.hi, box.hi * 2 - box.lo};
  const bool within = random.below(2) == 0;
  const Vec3 origin = random_point_in(within ? box : around, random);
  const auto& triangle =
      mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
  const auto corner = [&](std::size_t i) {
    const auto& p = mesh.positions[triangle[i]];
    return Vec3{p[0], p[1], p[2]};
  };
  const double s = random.uniform();
  const double t = random.uniform() * (1 - s);
  Vec3 target = random_point_in(box, random);
  switch (random.below(4)) {
    case 0:
      target = corner(0);
      break;
    case 1:
      target = lerp(corner(0), corner(1), s);
      break;
    case 2:
      target = corner(0) + s * (corner(1) - corner(0)) + t * (corner(2) - corner(0));
      break;
    default:
      break;
  }
  const Vec3 direction = target - origin;
  return {origin, random.below(2) == 0 ? direction : direction * 0x1p-37};
}

}  // namespace bandsaw::test
