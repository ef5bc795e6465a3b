// Computes the surface at a hit, first in the primitive's own space and then in the world. For
// meshes the first step is in this file, for loose shapes in shape_surface.h.

#include "renderlib/geometry/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderlib/geometry/deforming_mesh.h"
#include "renderlib/geometry/placement.h"
#include "renderlib/geometry/shape_surface.h"
#include "renderlib/math/float3.h"

namespace bandsaw {
namespace {

/// A mesh triangle in the mesh's space: corner a, and the edges from a to b and to c.
struct Corners {
  Vec3 a;
  Vec3 e1;
  Vec3 e2;
};

/// Returns the triangle that was hit, at the time of the ray.
Corners corners(const Mesh& mesh, const Interval& shutter, double time, const Hit& hit) {
  std::array<Vec3, 3> at;
  if (hit.corners != nullptr) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float* const corner = hit.corners + 3 * c * kCornerStride;
      at[c] = {corner[0], corner[kCornerStride], corner[2 * kCornerStride]};
    }
  } else {
    const auto now = corners_at(mesh, hit.id.primitive, shutter, time);
    at = {vec3(now[0]), vec3(now[1]), vec3(now[2])};
  }
  return {at[0], at[1] - at[0], at[2] - at[0]};
}

/// Interpolates the values `at` the corners of a triangle.
Vec3 interpolate(const std::array<std::array<float, 3>, 3>& at, const Hit& hit) {
  return vec3(at[0]) * (1 - hit.u - hit.v) + vec3(at[1]) * hit.u + vec3(at[2]) * hit.v;
}

/// Returns the interpolated uv, or `otherwise` if the mesh has no such uvs.
Vec2 mesh_uv(const std::vector<std::array<float, 2>>& uvs,
             const std::array<std::uint32_t, 3>& index, const Hit& hit, const Vec2& otherwise) {
  if (uvs.empty()) {
    return otherwise;
  }
  const auto uv = [&](std::size_t corner) {
    const auto& value = uvs[index[corner]];
    return Vec2{value[0], value[1]};
  };
  return uv(0) * (1 - hit.u - hit.v) + uv(1) * hit.u + uv(2) * hit.v;
}

/// Returns the interpolated vertex colour. The mesh MUST have colours.
Rgb mesh_color(const Mesh& mesh, const std::array<std::uint32_t, 3>& index, const Hit& hit) {
  const auto color = [&](std::size_t corner) {
    const auto& value = mesh.colors[index[corner]];
    return Rgb{value[0], value[1], value[2]};
  };
  return color(0) * static_cast<float>(1 - hit.u - hit.v) + color(1) * static_cast<float>(hit.u) +
         color(2) * static_cast<float>(hit.v);
}

/// Returns the surface at a hit of a mesh's triangle, in the mesh's space.
SurfacePoint on_triangle(const Mesh& mesh, const Interval& shutter, const Ray& ray,
                         const Hit& hit) {
  const Corners local = corners(mesh, shutter, ray.time, hit);
  const std::array<std::uint32_t, 3>& index = mesh.triangles[hit.id.primitive];
  SurfacePoint p;
  p.position = local.a + hit.u * local.e1 + hit.v * local.e2;
  p.object_position = p.position;
  p.geometric_normal = flat_normal(local.e1, local.e2, ray);
  p.shading_normal = p.geometric_normal;
  if (!mesh.normals.empty()) {
    const Vec3 n =
        interpolate(corners_at(mesh.normals, mesh.normals_at_close, index, shutter, ray.time), hit);
    p.shading_normal = same_side(unit_or(n, p.geometric_normal), p.geometric_normal);
  }
  p.uv = mesh_uv(mesh.uvs, index, hit, {hit.u, hit.v});
  p.uv2 = mesh_uv(mesh.uvs2, index, hit, p.uv);
  if (!mesh.colors.empty()) {
    p.color = mesh_color(mesh, index, hit);
  }
  const double size = std::max(max_abs(local.e1), max_abs(local.e2));
  p.offset = surface_offset({}, max_abs(p.position) + size);
  return p;
}

/// Returns the surface at a hit of an instance of a mesh, in world space.
SurfacePoint on_mesh(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  const Instance& instance = geometry.instances[hit.id.instance - 1];
  SurfacePoint p =
      on_triangle(geometry.meshes[index_of(instance.mesh)], geometry.shutter, ray, hit);
  const bool in_place = instance.frame == kNoFrame && instance.to_world == Transform{};
  if (!in_place) {
    p = placed(p, to_world_at(geometry, instance, ray.time), ray);
  }
  p.material = instance.material;
  return p;
}

/// Returns the surface at a hit of an instance of a group of shapes, in world space.
SurfacePoint on_group(const Geometry& geometry, const Ray& ray, const Hit& hit, bool sphere_uv) {
  const Instance& instance = geometry.instances[hit.id.instance - 1];
  const Transform to_world = to_world_at(geometry, instance, ray.time);
  const Transform to_object = inverse(to_world).value_or(Transform{});
  Ray local = ray;
  local.origin = to_object.point(ray.origin);
  local.direction = to_object.direction(ray.direction);
  SurfacePoint p =
      placed(on_shape(*group_of(geometry, instance), local, hit, sphere_uv), to_world, ray);
  p.material = instance.material == kOwnMaterial ? p.material : instance.material;
  return p;
}

SurfacePoint on_instance(const Geometry& geometry, const Ray& ray, const Hit& hit, bool sphere_uv) {
  const bool group = geometry.instances[hit.id.instance - 1].group != kNoGroup;
  return group ? on_group(geometry, ray, hit, sphere_uv) : on_mesh(geometry, ray, hit);
}

}  // namespace

void prepare_surfaces(Geometry& geometry) {
  prepare_normals(geometry);
  for (Shapes& group : geometry.groups) {
    prepare_normals(group);
  }
}

SurfacePoint surface_at(const Geometry& geometry, const Ray& ray, const Hit& hit, bool sphere_uv) {
  SurfacePoint p = hit.id.instance == 0 ? on_shape(geometry, ray, hit, sphere_uv)
                                        : on_instance(geometry, ray, hit, sphere_uv);
  p.id = hit.id;
  p.time = ray.time;
  p.t = hit.t;
  if (!p.squashed) {
    p.away = p.geometric_normal * p.offset;
  }
  return p;
}

Ray spawn_ray_to(const SurfacePoint& from, const Vec3& target, double target_offset) {
  const Ray ray = spawn_ray(from, target - from.position);
  const Vec3 to_target = target - ray.origin;
  const double shorter = target_offset > 0 ? target_offset / length(to_target) : 0;
  return {ray.origin, to_target, 1 - shorter, from.id, from.time};
}

Ray spawn_ray_to(const SurfacePoint& from, const SurfacePoint& target) {
  const bool behind = dot(from.position - target.position, target.geometric_normal) < 0;
  return spawn_ray_to(from, behind ? target.position - target.away : target.position + target.away,
                      0);
}

}  // namespace bandsaw
