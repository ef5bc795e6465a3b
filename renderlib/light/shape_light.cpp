#include "renderlib/light/shape_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderlib/sampling/sphere_light.h"
#include "renderlib/sampling/spherical_rectangle.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

using Kind = ShapeView::Kind;

Vec3 vertex(const Mesh& mesh, std::uint32_t index) {
  const std::array<float, 3>& p = mesh.positions[index];
  return {p[0], p[1], p[2]};
}

ShapeView triangle_view(const Vec3& a, const Vec3& b, const Vec3& c, bool mirrored) {
  return {.kind = Kind::kTriangle, .a = a, .u = b - a, .v = c - a, .mirrored = mirrored};
}

ShapeView mesh_view(const Geometry& geometry, PrimitiveId id) {
  const Instance& instance = geometry.instances[id.instance - 1];
  const Mesh& mesh = geometry.meshes[index_of(instance.mesh)];
  const std::array<std::uint32_t, 3>& t = mesh.triangles[id.primitive];
  const Transform& to_world = instance.to_world;
  return triangle_view(to_world.point(vertex(mesh, t[0])), to_world.point(vertex(mesh, t[1])),
                       to_world.point(vertex(mesh, t[2])), determinant(to_world) < 0);
}

/// Which of the loose shapes a primitive of instance 0 is.
struct Loose {
  Kind kind;
  std::size_t index;
};

Loose loose_shape(const Geometry& geometry, std::uint32_t primitive) {
  std::size_t index = primitive;
  if (index < geometry.spheres.size()) {
    return {Kind::kSphere, index};
  }
  index -= geometry.spheres.size();
  if (index < geometry.quads.size()) {
    return {Kind::kQuad, index};
  }
  return {Kind::kTriangle, index - geometry.quads.size()};
}

std::optional<SphericalRectangle> seen_rectangle(const ShapeView& shape, const Vec3& from) {
  if (shape.kind != Kind::kQuad || !is_rectangle(shape.u, shape.v)) {
    return std::nullopt;
  }
  return SphericalRectangle::seen_from(from, shape.a, shape.u, shape.v);
}

/// Coordinates of a uniform point: of the parallelogram themselves; of the triangle by the square
/// root that makes the distance from `a` uniform in area (Pharr, Jakob, Humphreys, "Physically
/// Based Rendering", A.5.4).
Vec2 uniform_on(Kind kind, double u, double v) {
  if (kind == Kind::kQuad) {
    return {u, v};
  }
  const double far = std::sqrt(u);
  return {far * (1 - v), far * v};
}

std::optional<ShapeSample> sample_flat(const ShapeView& shape, const Vec3& from, double u,
                                       double v) {
  const Vec3 normal = flat_normal(shape);
  ShapeSample sample;
  sample.normal = normalize(normal);
  const std::optional<SphericalRectangle> rectangle = seen_rectangle(shape, from);
  sample.on_shape = rectangle ? rectangle->sample(u, v) : uniform_on(shape.kind, u, v);
  sample.position = shape.a + shape.u * sample.on_shape.x + shape.v * sample.on_shape.y;
  sample.pdf = rectangle ? 1 / rectangle->solid_angle()
                         : solid_angle_pdf(1 / area(shape), from, sample.position, sample.normal);
  return sample;
}

}  // namespace

ShapeView shape_view(const Geometry& geometry, PrimitiveId id) {
  if (id.instance != 0) {
    return mesh_view(geometry, id);
  }
  const Loose loose = loose_shape(geometry, id.primitive);
  if (loose.kind == Kind::kSphere) {
    const Sphere& sphere = geometry.spheres[loose.index];
    return {.kind = Kind::kSphere, .a = sphere.center, .radius = sphere.radius};
  }
  if (loose.kind == Kind::kQuad) {
    const Quad& quad = geometry.quads[loose.index];
    return {.kind = Kind::kQuad, .a = quad.corner, .u = quad.u, .v = quad.v};
  }
  const Triangle& triangle = geometry.triangles[loose.index];
  return triangle_view(triangle.a, triangle.b, triangle.c, false);
}

MaterialId material_of(const Geometry& geometry, PrimitiveId id) {
  if (id.instance != 0) {
    return geometry.instances[id.instance - 1].material;
  }
  const Loose loose = loose_shape(geometry, id.primitive);
  return loose.kind == Kind::kSphere ? geometry.spheres[loose.index].material
         : loose.kind == Kind::kQuad ? geometry.quads[loose.index].material
                                     : geometry.triangles[loose.index].material;
}

double area(const ShapeView& shape) {
  if (shape.kind == Kind::kSphere) {
    return 4 * kPi * shape.radius * shape.radius;
  }
  const double parallelogram = length(cross(shape.u, shape.v));
  return shape.kind == Kind::kQuad ? parallelogram : parallelogram / 2;
}

Vec3 flat_normal(const ShapeView& shape) {
  return shape.mirrored ? cross(shape.v, shape.u) : cross(shape.u, shape.v);
}

Ball bounds(const ShapeView& shape) {
  if (shape.kind == Kind::kSphere) {
    return {shape.a, shape.radius};
  }
  if (shape.kind == Kind::kQuad) {
    const double diagonal = std::max(length(shape.u + shape.v), length(shape.u - shape.v));
    return {shape.a + (shape.u + shape.v) / 2, diagonal / 2};
  }
  const Vec3 center = (shape.u + shape.v) / 3;
  const double radius =
      std::sqrt(std::max({length_squared(center), length_squared(shape.u - center),
                          length_squared(shape.v - center)}));
  return {shape.a + center, radius};
}

std::optional<ShapeSample> sample(const ShapeView& shape, const Vec3& from, double u, double v) {
  std::optional<ShapeSample> sample;
  if (shape.kind == Kind::kSphere) {
    if (const auto on_sphere = sample_sphere_light(shape.a, shape.radius, from, u, v)) {
      sample = ShapeSample{on_sphere->position, on_sphere->normal, {}, on_sphere->pdf};
    }
  } else {
    sample = sample_flat(shape, from, u, v);
  }
  return sample && sample->pdf > 0 && std::isfinite(sample->pdf) ? sample : std::nullopt;
}

double direction_pdf(const ShapeView& shape, const Vec3& from, const Vec3& position,
                     const Vec3& normal) {
  if (shape.kind == Kind::kSphere) {
    return sphere_light_pdf(shape.a, shape.radius, from, position, normal);
  }
  if (const std::optional<SphericalRectangle> rectangle = seen_rectangle(shape, from)) {
    return 1 / rectangle->solid_angle();
  }
  const double pdf = solid_angle_pdf(1 / area(shape), from, position, normal);
  return std::isfinite(pdf) ? pdf : 0;
}

}  // namespace bandsaw
