#include "renderlib/import/read_shapes.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/numbers.h"
#include "renderlib/import/read_materials.h"

namespace bandsaw {
namespace {

absl::Status read_sphere(const Field& in, const scene::Sphere& from, MaterialId material,
                         Geometry& geometry) {
  Sphere sphere;
  ASSIGN_OR_RETURN(sphere.center, read_vec3(in, "center", from.center(), Vec3{}));
  if (!from.has_radius()) {
    return in.error("radius", "is required and must be > 0");
  }
  sphere.radius = from.radius();
  if (!(std::isfinite(sphere.radius) && sphere.radius > 0)) {
    return in.error("radius", absl::StrCat("must be finite and > 0, is ", sphere.radius));
  }
  sphere.material = material;
  geometry.spheres.push_back(sphere);
  return absl::OkStatus();
}

absl::Status read_quad(const Field& in, const scene::Quad& from, MaterialId material,
                       Geometry& geometry) {
  Quad quad;
  ASSIGN_OR_RETURN(quad.corner, read_vec3(in, "corner", from.corner()));
  ASSIGN_OR_RETURN(quad.u, read_direction(in, "u", from.u()));
  ASSIGN_OR_RETURN(quad.v, read_direction(in, "v", from.v()));
  const Vec3 normal = cross(normalize(quad.u), normalize(quad.v));
  if (!(length_squared(normal) > 1e-24)) {
    return in.error("v", "must not be parallel to u: the quad would have no area");
  }
  quad.material = material;
  geometry.quads.push_back(quad);
  return absl::OkStatus();
}

absl::Status read_triangle(const Field& in, const scene::Triangle& from, MaterialId material,
                           Geometry& geometry) {
  Triangle triangle;
  ASSIGN_OR_RETURN(triangle.a, read_vec3(in, "a", from.a()));
  ASSIGN_OR_RETURN(triangle.b, read_vec3(in, "b", from.b()));
  ASSIGN_OR_RETURN(triangle.c, read_vec3(in, "c", from.c()));
  triangle.material = material;
  geometry.triangles.push_back(triangle);
  return absl::OkStatus();
}

absl::Status read_box(const Field& in, const scene::Box& from, MaterialId material,
                      Geometry& geometry) {
  ASSIGN_OR_RETURN(const Vec3 low, read_vec3(in, "min", from.min()));
  ASSIGN_OR_RETURN(const Vec3 high, read_vec3(in, "max", from.max()));
  if (!(high.x > low.x && high.y > low.y && high.z > low.z)) {
    return in.error("max", "must be above min in x, y and z: the box would have no volume");
  }
  const Vec3 x{high.x - low.x, 0, 0};
  const Vec3 y{0, high.y - low.y, 0};
  const Vec3 z{0, 0, high.z - low.z};
  for (const Quad& side : {Quad{{low.x, low.y, high.z}, x, y, material},    // +z
                           Quad{{high.x, low.y, high.z}, -z, y, material},  // +x
                           Quad{{high.x, low.y, low.z}, -x, y, material},   // -z
                           Quad{low, z, y, material},                       // -x
                           Quad{{low.x, high.y, high.z}, x, -z, material},  // +y
                           Quad{low, x, z, material}}) {                    // -y
    geometry.quads.push_back(side);
  }
  return absl::OkStatus();
}

absl::Status read_shape(const Field& in, const scene::Shape& from, MaterialId material,
                        Geometry& geometry) {
  switch (from.kind_case()) {
    case scene::Shape::kSphere:
      return read_sphere(in.child("sphere"), from.sphere(), material, geometry);
    case scene::Shape::kQuad:
      return read_quad(in.child("quad"), from.quad(), material, geometry);
    case scene::Shape::kTriangle:
      return read_triangle(in.child("triangle"), from.triangle(), material, geometry);
    case scene::Shape::kBox:
      return read_box(in.child("box"), from.box(), material, geometry);
    case scene::Shape::KIND_NOT_SET:
      break;
  }
  return in.error("is of no kind: write sphere, quad, triangle or box");
}

}  // namespace

absl::Status read_shapes(const Field& root, const scene::Scene& from, SceneDraft& draft) {
  for (int i = 0; i < from.shape_size(); ++i) {
    const Field in = root.child("shape", i);
    ASSIGN_OR_RETURN(const MaterialId material, find_material(in, from.shape(i).material(), draft));
    RETURN_IF_ERROR(read_shape(in, from.shape(i), material, draft.out.scene.geometry));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
