#include "renderlib/geometry/surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderlib/geometry/sphere_uv.h"

namespace bandsaw {
namespace {

constexpr double kOffset = 0x1p-40;

Vec3 vec(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

/// The unit vector along `v`, or `otherwise` where v has none (zero or not finite).
Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
  const double size = max_abs(v);
  return size > 0 && std::isfinite(size) && is_finite(v) ? normalize(v / size) : otherwise;
}

/// The unit normal of a triangle with these edges; a triangle without area faces the ray.
Vec3 flat_normal(const Vec3& e1, const Vec3& e2, const Ray& ray) {
  const double s1 = std::max(max_abs(e1), 0x1p-1000);
  const double s2 = std::max(max_abs(e2), 0x1p-1000);
  return unit_or(cross(e1 / s1, e2 / s2), unit_or(-ray.direction, {0, 0, 1}));
}

Vec3 same_side(const Vec3& n, const Vec3& reference) { return dot(n, reference) < 0 ? -n : n; }

/// A mesh triangle in its own space.
struct Corners {
  Vec3 a;
  Vec3 e1;
  Vec3 e2;
  std::array<std::uint32_t, 3> index;
};

Corners corners(const Mesh& mesh, std::uint32_t primitive) {
  const auto& index = mesh.triangles[primitive];
  const Vec3 a = vec(mesh.positions[index[0]]);
  return {a, vec(mesh.positions[index[1]]) - a, vec(mesh.positions[index[2]]) - a, index};
}

/// How the linear part of a placement treats normals and lengths.
struct Placement {
  explicit Placement(const Transform& t) {
    for (std::size_t i = 0; i < 3; ++i) {
      rows[i] = {t.m[i][0], t.m[i][1], t.m[i][2]};
    }
    for (std::size_t i = 0; i < 3; ++i) {
      cofactors[i] = cross(rows[(i + 1) % 3], rows[(i + 2) % 3]);
    }
    determinant = dot(rows[0], cofactors[0]);
  }
  /// M^-T n times |det M|: normals stay outside in mirrored placements too.
  Vec3 normal(const Vec3& n) const {
    const Vec3 c = {dot(cofactors[0], n), dot(cofactors[1], n), dot(cofactors[2], n)};
    return determinant < 0 ? -c : c;
  }
  static double norm(const std::array<Vec3, 3>& m) {
    return std::sqrt(length_squared(m[0]) + length_squared(m[1]) + length_squared(m[2]));
  }
  /// |M| |M^-1| in Frobenius norms.
  double condition() const { return norm(rows) * norm(cofactors) / std::abs(determinant); }

  std::array<Vec3, 3> rows;
  std::array<Vec3, 3> cofactors;
  double determinant;
};

Vec3 interpolate(const std::array<float, 3>& a, const std::array<float, 3>& b,
                 const std::array<float, 3>& c, const Hit& hit) {
  return vec(a) * (1 - hit.u - hit.v) + vec(b) * hit.u + vec(c) * hit.v;
}

/// `otherwise` where the mesh has no such uvs.
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

Rgb mesh_color(const Mesh& mesh, const std::array<std::uint32_t, 3>& index, const Hit& hit) {
  const auto color = [&](std::size_t corner) {
    const auto& value = mesh.colors[index[corner]];
    return Rgb{value[0], value[1], value[2]};
  };
  return color(0) * static_cast<float>(1 - hit.u - hit.v) + color(1) * static_cast<float>(hit.u) +
         color(2) * static_cast<float>(hit.v);
}

SurfacePoint on_mesh(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  const Instance& instance = geometry.instances[hit.id.instance - 1];
  const Mesh& mesh = geometry.meshes[index_of(instance.mesh)];
  const Corners local = corners(mesh, hit.id.primitive);
  const Placement placement(instance.to_world);
  const Vec3 local_position = local.a + hit.u * local.e1 + hit.v * local.e2;
  SurfacePoint p;
  p.position = instance.to_world.point(local_position);
  p.object_position = local_position;
  p.geometric_normal = unit_or(placement.normal(flat_normal(local.e1, local.e2, ray)),
                               unit_or(-ray.direction, {0, 0, 1}));
  p.shading_normal = p.geometric_normal;
  if (!mesh.normals.empty()) {
    const Vec3 n = interpolate(mesh.normals[local.index[0]], mesh.normals[local.index[1]],
                               mesh.normals[local.index[2]], hit);
    p.shading_normal =
        same_side(unit_or(placement.normal(n), p.geometric_normal), p.geometric_normal);
  }
  p.uv = mesh_uv(mesh.uvs, local.index, hit, {hit.u, hit.v});
  p.uv2 = mesh_uv(mesh.uvs2, local.index, hit, p.uv);
  if (!mesh.colors.empty()) {
    p.color = mesh_color(mesh, local.index, hit);
  }
  p.material = instance.material;
  // The largest numbers that went into the position: they bound its rounding. Rays come back
  // through the inverse, which can make rounding of the origin larger by the condition of the
  // placement; the factor 2^-8 is what 2^-40 has in reserve.
  const double size = std::max(max_abs(local.e1), max_abs(local.e2));
  const double object = (max_abs(local_position) + size) * Placement::norm(placement.rows);
  const auto& m = instance.to_world.m;
  const double moved = max_abs(Vec3{m[0][3], m[1][3], m[2][3]});
  const double scale = std::max({max_abs(p.position), object, moved});
  p.offset = surface_offset({}, scale * std::max(1.0, 0x1p-8 * placement.condition()));
  return p;
}

SurfacePoint on_sphere(const Sphere& sphere, const Ray& ray, const Hit& hit) {
  const Vec3 outward = (ray.origin - sphere.center) + ray.direction * hit.t;
  SurfacePoint p;
  p.geometric_normal = unit_or(outward, unit_or(-ray.direction, {0, 0, 1}));
  p.shading_normal = p.geometric_normal;
  p.position = sphere.center + p.geometric_normal * sphere.radius;
  p.object_position = p.geometric_normal * sphere.radius;
  p.uv = sphere_uv(p.geometric_normal);
  p.uv2 = p.uv;
  p.material = sphere.material;
  p.offset = surface_offset(p.position, sphere.radius + max_abs(sphere.center));
  return p;
}

SurfacePoint on_flat(const Vec3& a, const Vec3& e1, const Vec3& e2, MaterialId material,
                     const Ray& ray, const Hit& hit) {
  SurfacePoint p;
  p.position = a + hit.u * e1 + hit.v * e2;
  p.geometric_normal = flat_normal(e1, e2, ray);
  p.shading_normal = p.geometric_normal;
  p.object_position = p.position;
  p.uv = {hit.u, hit.v};
  p.uv2 = p.uv;
  p.material = material;
  p.offset = surface_offset(p.position, max_abs(a) + std::max(max_abs(e1), max_abs(e2)));
  return p;
}

SurfacePoint on_loose(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  std::size_t i = hit.id.primitive;
  if (i < geometry.spheres.size()) {
    return on_sphere(geometry.spheres[i], ray, hit);
  }
  i -= geometry.spheres.size();
  if (i < geometry.quads.size()) {
    const Quad& quad = geometry.quads[i];
    return on_flat(quad.corner, quad.u, quad.v, quad.material, ray, hit);
  }
  const Triangle& triangle = geometry.triangles[i - geometry.quads.size()];
  return on_flat(triangle.a, triangle.b - triangle.a, triangle.c - triangle.a, triangle.material,
                 ray, hit);
}

}  // namespace

double surface_offset(const Vec3& position, double size) {
  return kOffset * std::max(max_abs(position), size);
}

SurfacePoint surface_at(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  SurfacePoint p =
      hit.id.instance == 0 ? on_loose(geometry, ray, hit) : on_mesh(geometry, ray, hit);
  p.id = hit.id;
  return p;
}

Ray leave(const SurfacePoint& from, const Vec3& direction, double t_max) {
  const double side = dot(direction, from.geometric_normal) < 0 ? -from.offset : from.offset;
  return {from.position + from.geometric_normal * side, direction, t_max, from.id};
}

Ray toward(const SurfacePoint& from, const Vec3& target, double target_offset) {
  const Ray ray = leave(from, target - from.position);
  const Vec3 way = target - ray.origin;
  const double shorter = target_offset > 0 ? target_offset / length(way) : 0;
  return {ray.origin, way, 1 - shorter, from.id};
}

Ray toward(const SurfacePoint& from, const Vec3& target, double target_offset,
           const Vec3& target_normal) {
  const double side =
      dot(from.position - target, target_normal) < 0 ? -target_offset : target_offset;
  return toward(from, target + target_normal * side, 0);
}

}  // namespace bandsaw
