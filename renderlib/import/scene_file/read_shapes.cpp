// Converts each shape of a scene file to a shape of geometry/shapes.h, and a box to six quads. A
// shape that moves becomes a group in a frame, a moving coordinate system (geometry/frame.h). If a
// shape has a medium inside, a boundary is added too, which is the closed shape that the medium
// fills. Contents::seen holds the placed shapes that have a surface, Contents::filled the
// boundaries.

#include "renderlib/import/scene_file/read_shapes.h"

#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_materials.h"
#include "renderlib/import/scene_file/read_media.h"

namespace bandsaw {
namespace {

absl::Status read_sphere(const Field& in, const scene::Sphere& from, MaterialId material,
                         Shapes& geometry) {
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
                       Shapes& geometry) {
  Quad quad;
  ASSIGN_OR_RETURN(quad.corner, read_vec3(in, "corner", from.corner()));
  ASSIGN_OR_RETURN(quad.u, read_direction(in, "u", from.u()));
  ASSIGN_OR_RETURN(quad.v, read_direction(in, "v", from.v()));
  const Vec3 normal = cross(normalize(quad.u), normalize(quad.v));
  // The sine of the angle between the sides must be above 1e-12.
  if (!(length_squared(normal) > 1e-24)) {
    return in.error("v", "must not be parallel to u: the quad would have no area");
  }
  quad.material = material;
  geometry.quads.push_back(quad);
  return absl::OkStatus();
}

absl::Status read_triangle(const Field& in, const scene::Triangle& from, MaterialId material,
                           Shapes& geometry) {
  Triangle triangle;
  ASSIGN_OR_RETURN(triangle.a, read_vec3(in, "a", from.a()));
  ASSIGN_OR_RETURN(triangle.b, read_vec3(in, "b", from.b()));
  ASSIGN_OR_RETURN(triangle.c, read_vec3(in, "c", from.c()));
  triangle.material = material;
  geometry.triangles.push_back(triangle);
  return absl::OkStatus();
}

absl::Status read_box(const Field& in, const scene::Box& from, MaterialId material,
                      Shapes& geometry) {
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

absl::Status read_disk(const Field& in, const scene::Disk& from, MaterialId material,
                       Shapes& geometry) {
  Disk disk;
  ASSIGN_OR_RETURN(disk.center, read_vec3(in, "center", from.center(), Vec3{}));
  ASSIGN_OR_RETURN(const Vec3 normal, read_direction(in, "normal", from.normal()));
  disk.normal = normalize(normal / max_abs(normal));
  if (!from.has_radius()) {
    return in.error("radius", "is required and must be > 0");
  }
  disk.radius = from.radius();
  if (!(std::isfinite(disk.radius) && disk.radius > 0)) {
    return in.error("radius", absl::StrCat("must be finite and > 0, is ", disk.radius));
  }
  disk.material = material;
  geometry.disks.push_back(disk);
  return absl::OkStatus();
}

absl::Status read_shape(const Field& in, const scene::Shape& from, MaterialId material,
                        Shapes& geometry) {
  switch (from.kind_case()) {
    case scene::Shape::kSphere:
      return read_sphere(in.child("sphere"), from.sphere(), material, geometry);
    case scene::Shape::kQuad:
      return read_quad(in.child("quad"), from.quad(), material, geometry);
    case scene::Shape::kTriangle:
      return read_triangle(in.child("triangle"), from.triangle(), material, geometry);
    case scene::Shape::kBox:
      return read_box(in.child("box"), from.box(), material, geometry);
    case scene::Shape::kDisk:
      return read_disk(in.child("disk"), from.disk(), material, geometry);
    case scene::Shape::KIND_NOT_SET:
      break;
  }
  return in.error("has no kind: write sphere, quad, triangle, box or disk");
}

/// Appends the shapes, translated by `by`.
void add_moved(const Shapes& shape, const Vec3& by, Shapes& to) {
  for (Sphere sphere : shape.spheres) {
    sphere.center = sphere.center + by;
    to.spheres.push_back(sphere);
  }
  for (Quad quad : shape.quads) {
    quad.corner = quad.corner + by;
    to.quads.push_back(quad);
  }
  for (const Triangle& t : shape.triangles) {
    to.triangles.push_back({t.a + by, t.b + by, t.c + by, t.material});
  }
  for (Disk disk : shape.disks) {
    disk.center = disk.center + by;
    to.disks.push_back(disk);
  }
}

/// Returns a frame that moves linearly while the shutter is open; the shutter MUST have a duration.
Frame sliding(const Vec3& velocity, const Shutter& shutter) {
  Frame frame;
  frame.keys.emplace_back(shutter.open, translation(velocity * shutter.open));
  frame.keys.emplace_back(shutter.close, translation(velocity * shutter.close));
  return frame;
}

/// Adds a moving shape as a group, placed in its own frame.
void add_moving(Shapes shape, const Vec3& velocity, SceneDraft& draft) {
  Geometry& geometry = draft.out.scene.geometry;
  Placements& to = draft.placed->seen;
  geometry.groups.push_back(std::move(shape));
  Instance instance;
  instance.group = GroupId{static_cast<std::uint32_t>(geometry.groups.size() - 1)};
  instance.material = kOwnMaterial;
  instance.frame = add_frame(sliding(velocity, draft.shutter), to);
  to.instances.push_back(instance);
}

/// Returns the boundary of the medium inside a sphere or a box.
absl::StatusOr<Instance> read_boundary(const Field& in, const scene::Shape& from,
                                       SceneDraft& draft) {
  if (from.kind_case() != scene::Shape::kSphere && from.kind_case() != scene::Shape::kBox) {
    return in.error("interior",
                    "needs a closed shape, and this one encloses nothing: use a box, a sphere or a "
                    "closed model");
  }
  ASSIGN_OR_RETURN(const MediumId medium, find_medium(in, "interior", from.interior(), draft));
  Shapes shape;
  RETURN_IF_ERROR(read_shape(in, from, MaterialId{}, shape));
  if (from.kind_case() == scene::Shape::kSphere) {
    return boundary_of(shape.spheres.front(), medium, draft);
  }
  const Field box = in.child("box");
  ASSIGN_OR_RETURN(const Vec3 low, read_vec3(box, "min", from.box().min()));
  ASSIGN_OR_RETURN(const Vec3 high, read_vec3(box, "max", from.box().max()));
  return boundary_of(low, high, medium, draft);
}

/// Adds the medium inside a sphere that rests in the scene. The boundary of this medium is stored
/// as a sphere, not as an instance.
absl::Status read_filled_sphere(const Field& in, const scene::Shape& from, SceneDraft& draft) {
  ASSIGN_OR_RETURN(const MediumId medium, find_medium(in, "interior", from.interior(), draft));
  return read_shape(in, from, filled_with(medium), draft.out.scene.media.boundaries);
}

/// Adds the boundary of the medium inside a sphere or a box. If the shutter has a duration, the
/// boundary moves with the shape.
absl::Status read_interior(const Field& in, const scene::Shape& from, SceneDraft& draft) {
  const bool rests_in_scene = draft.placed == &draft.world && from.velocity().empty();
  if (rests_in_scene && from.kind_case() == scene::Shape::kSphere) {
    return read_filled_sphere(in, from, draft);
  }
  ASSIGN_OR_RETURN(Instance boundary, read_boundary(in, from, draft));
  Placements& to = draft.placed->filled;
  const Shutter& shutter = draft.shutter;
  Vec3 velocity;
  if (!from.velocity().empty()) {
    ASSIGN_OR_RETURN(velocity, read_vec3(in, "velocity", from.velocity()));
  }
  if (!from.velocity().empty() && shutter.open != shutter.close) {
    boundary.frame = add_frame(sliding(velocity, shutter), to);
  } else {
    place_boundary(translation(velocity * shutter.open), boundary, draft, to);
  }
  to.instances.push_back(boundary);
  return absl::OkStatus();
}

}  // namespace

absl::Status read_shapes(const Field& parent, const ShapeList& shapes, SceneDraft& draft) {
  for (int i = 0; i < shapes.size(); ++i) {
    const Field in = parent.child("shape", i);
    const scene::Shape& from = shapes[i];
    if (!from.interior().empty()) {
      RETURN_IF_ERROR(read_interior(in, from, draft));
      if (from.material().empty()) {
        continue;  // its surface is invisible
      }
    }
    ASSIGN_OR_RETURN(const MaterialId material, find_material(in, from.material(), draft));
    if (from.velocity().empty()) {
      RETURN_IF_ERROR(read_shape(in, from, material, *draft.shapes));
      continue;
    }
    ASSIGN_OR_RETURN(const Vec3 velocity, read_vec3(in, "velocity", from.velocity()));
    Shapes moving;
    RETURN_IF_ERROR(read_shape(in, from, material, moving));
    if (draft.shutter.open == draft.shutter.close) {
      add_moved(moving, velocity * draft.shutter.open, *draft.shapes);
    } else {
      add_moving(std::move(moving), velocity, draft);
    }
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
