// Converts the shapes of a Mitsuba scene to those of Bandsaw scene files. add_kind() calls one
// function for each type of shape. A shape becomes a mesh if scene files have no such type
// (cylinders), or if the type in scene files cannot have the orientation or the uv coordinates of
// the shape (spheres turned inside out, textured disks).
//
// A surface is turned if Mitsuba's outside is the inside of Bandsaw's shape. It is turned if the
// shape has flip_normals or if its material exchanges the two sides (SurfaceMaterial::turned), but
// not if both hold. For a rectangle, a transform that mirrors (determinant < 0) also exchanges the
// sides.
//
// A rectangle, a disk and a cylinder are not closed, so they cannot contain a medium. Their
// functions use `open`, a copy of the surface without its interior.

#include "renderlib/import/mitsuba/shapes.h"

#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/math/float3.h"

namespace bandsaw::mitsuba {
namespace {

void add_numbers(const Vec3& v, google::protobuf::RepeatedField<double>* to) {
  to->Add(v.x);
  to->Add(v.y);
  to->Add(v.z);
}

/// Returns the factor of a transform that scales all directions alike; std::nullopt for others.
std::optional<double> uniform_scale(const Transform& t) {
  const Vec3 x = t.direction({1, 0, 0});
  const Vec3 y = t.direction({0, 1, 0});
  const Vec3 z = t.direction({0, 0, 1});
  const double scale = length(x);
  const double tolerance = 1e-9 * scale * scale;
  const bool uniform = std::abs(length_squared(y) - scale * scale) <= tolerance &&
                       std::abs(length_squared(z) - scale * scale) <= tolerance &&
                       std::abs(dot(x, y)) <= tolerance && std::abs(dot(y, z)) <= tolerance &&
                       std::abs(dot(z, x)) <= tolerance;
  return uniform ? std::optional<double>(scale) : std::nullopt;
}

/// Returns the square [-1, 1]^2 in z = 0, as Mitsuba's rectangle.
SourceMesh rectangle_mesh() {
  SourceMesh out;
  out.mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  out.mesh.normals.assign(4, {0, 0, 1});
  out.mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  out.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return out;
}

/// Returns the cube [-1, 1]^3; each side has uvs from (0, 0) to (1, 1).
SourceMesh cube_mesh() {
  SourceMesh out;
  const auto side = [&](const Vec3& normal, const Vec3& u) {
    const Vec3 v = cross(normal, u);
    const auto first = static_cast<std::uint32_t>(out.mesh.positions.size());
    for (const auto& [s, t] :
         {std::pair(-1.0, -1.0), std::pair(1.0, -1.0), std::pair(1.0, 1.0), std::pair(-1.0, 1.0)}) {
      out.mesh.positions.push_back(float3(normal + u * s + v * t));
      out.mesh.normals.push_back(float3(normal));
      out.mesh.uvs.push_back({static_cast<float>((s + 1) / 2), static_cast<float>((t + 1) / 2)});
    }
    out.mesh.triangles.push_back({first, first + 1, first + 2});
    out.mesh.triangles.push_back({first, first + 2, first + 3});
  };
  side({0, -1, 0}, {-1, 0, 0});
  side({0, 1, 0}, {1, 0, 0});
  side({1, 0, 0}, {0, 1, 0});
  side({-1, 0, 0}, {0, 1, 0});
  side({0, 0, 1}, {1, 0, 0});
  side({0, 0, -1}, {1, 0, 0});
  return out;
}

constexpr int kSegments = 192;  ///< segments of round shapes that become meshes

/// Adds a strip of triangles between two rows of kSegments + 1 vertices, which start at the indices
/// `below` and `above`. A strip has two sides. From one of them, the rows run from left to right
/// and the row `above` is on top. Seen from this side, the vertices of each triangle are
/// counter-clockwise.
void add_strip(std::uint32_t below, std::uint32_t above, PlyMesh& mesh) {
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    mesh.triangles.push_back({below + i, below + i + 1, above + i + 1});
    mesh.triangles.push_back({below + i, above + i + 1, above + i});
  }
}

/// Returns the unit disk in z = 0; u is the distance from the centre, v the angle in turns.
SourceMesh disk_mesh() {
  SourceMesh out;
  for (const float radius : {0.0f, 1.0f}) {
    for (int i = 0; i <= kSegments; ++i) {
      const double turns = static_cast<double>(i) / kSegments;
      const SinCos at = sincos_turns(turns);
      out.mesh.positions.push_back(float3(Vec3{at.cos, at.sin, 0} * radius));
      out.mesh.normals.push_back({0, 0, 1});
      out.mesh.uvs.push_back({radius, static_cast<float>(turns)});
    }
  }
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    out.mesh.triangles.push_back({i, kSegments + 1 + i, kSegments + 2 + i});
  }
  return out;
}

/// Returns an open cylinder of radius 1 around z from 0 to 1; u is the angle in turns, v is z.
SourceMesh cylinder_mesh() {
  SourceMesh out;
  for (const float z : {0.0f, 1.0f}) {
    for (int i = 0; i <= kSegments; ++i) {
      const double turns = static_cast<double>(i) / kSegments;
      const SinCos at = sincos_turns(turns);
      out.mesh.positions.push_back(float3({at.cos, at.sin, z}));
      out.mesh.normals.push_back(float3({at.cos, at.sin, 0}));
      out.mesh.uvs.push_back({static_cast<float>(turns), z});
    }
  }
  add_strip(0, kSegments + 1, out.mesh);
  return out;
}

/// Returns the unit sphere; u is the angle around z in turns, v the angle from +z in half turns.
SourceMesh sphere_mesh() {
  SourceMesh out;
  constexpr int kRows = kSegments / 2;
  for (int row = 0; row <= kRows; ++row) {
    const SinCos down = sincos_turns(0.5 * row / kRows);
    for (int i = 0; i <= kSegments; ++i) {
      const SinCos around = sincos_turns(static_cast<double>(i) / kSegments);
      const Vec3 at{down.sin * around.cos, down.sin * around.sin, down.cos};
      out.mesh.positions.push_back(float3(at));
      out.mesh.normals.push_back(float3(at));
      out.mesh.uvs.push_back({static_cast<float>(i) / kSegments, static_cast<float>(row) / kRows});
    }
  }
  for (std::uint32_t row = 0; row < kRows; ++row) {
    add_strip((row + 1) * (kSegments + 1), row * (kSegments + 1), out.mesh);
  }
  return out;
}

}  // namespace

void set_matrix(const Transform& t, google::protobuf::RepeatedField<double>* to) {
  for (const auto& row : t.m) {
    for (const double entry : row) {
      to->Add(entry);
    }
  }
}

absl::Status ShapeReader::add(const Object& shape) {
  return add_to(shape, {scene_.mutable_shape(), scene_.mutable_model(), scene_.mutable_instance()});
}

absl::StatusOr<ShapeReader::Surface> ShapeReader::surface_of(const Parameters& from) {
  Surface surface;
  ASSIGN_OR_RETURN(surface.to_world, from.transform("to_world"));
  ASSIGN_OR_RETURN(surface.flip_normals, from.boolean("flip_normals", false));
  if (!inverse(surface.to_world)) {
    return error_at(from.place(), "to_world is singular: it flattens the shape");
  }
  const auto bsdfs = from.objects("bsdf");
  surface.bsdf = bsdfs.empty() ? nullptr : object_in(*bsdfs.back());
  auto emitters = from.objects("emitter");
  if (emitters.empty()) {
    emitters = from.objects("luminaire");
  }
  surface.emitter = emitters.empty() ? nullptr : object_in(*emitters.back());
  if (surface.emitter != nullptr && surface.emitter->type != "area") {
    to_.warn(surface.emitter->place,
             absl::StrCat("emitter \"", surface.emitter->type, "\" of a shape is left out"));
    surface.emitter = nullptr;
  }
  if (const Property* interior = from.find("interior")) {
    surface.interior = object_in(*interior);
  }
  if (const Property* exterior = from.find("exterior")) {
    to_.warn(exterior->place,
             "the exterior medium of a shape is left out; the medium that surrounds the shape is "
             "used instead");
  }
  return surface;
}

absl::Status ShapeReader::add_to(const Object& shape, const Target& target) {
  const Parameters from(shape);
  if (shape.type == "shapegroup") {
    return absl::OkStatus();
  }
  if (shape.type == "merge") {
    for (const Property* inside : from.objects("shape")) {
      RETURN_IF_ERROR(add_to(*object_in(*inside), target));
    }
    return absl::OkStatus();
  }
  if (shape.type == "instance") {
    RETURN_IF_ERROR(add_instance(from, target));
    to_.warn_of_unused(from);
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(const Surface surface, surface_of(from));
  const absl::Status added = add_kind(from, surface, target);
  if (absl::IsNotFound(added)) {
    to_.warn(from.place(), absl::StrCat(added.message(), "; the shape is left out"));
    return absl::OkStatus();
  }
  if (!added.ok()) {
    return at_place(from.place(), added);
  }
  to_.warn_of_unused(from);
  return absl::OkStatus();
}

/// Adds a shape that is not a group, a merge or an instance. Returns NOT_FOUND if a file is missing
/// or the type is not known.
absl::Status ShapeReader::add_kind(const Parameters& from, const Surface& surface,
                                   const Target& target) {
  const std::string& type = from.object().type;
  if (is_null(surface.bsdf) && surface.interior == nullptr && surface.emitter == nullptr) {
    from.ignore({"filename", "shape_index", "radius", "center", "p0", "p1", "face_normals",
                 "flip_tex_coords"});
    return absl::OkStatus();  // it cannot be seen
  }
  if (type == "obj" || type == "ply" || type == "serialized") {
    return add_mesh(from, surface, target);
  }
  if (type == "rectangle") {
    return add_rectangle(from, surface, target);
  }
  if (type == "cube") {
    return add_made_mesh(from, surface, cube_mesh(), target);
  }
  if (type == "sphere") {
    return add_sphere(from, surface, target);
  }
  if (type == "disk") {
    return add_disk(from, surface, target);
  }
  if (type == "cylinder") {
    return add_cylinder(from, surface, target);
  }
  return absl::NotFoundError(absl::StrCat("shape \"", type, "\" is not known"));
}

void ShapeReader::warn_of_interior(const Surface& surface, const Parameters& from) {
  if (surface.interior != nullptr) {
    to_.warn(from.place(), absl::StrCat("the medium inside a ", from.object().type,
                                        ", which is not closed, is left out"));
  }
}

absl::Status ShapeReader::add_model(const Parameters& from, const Surface& surface,
                                    const std::string& file, const std::string& material,
                                    const Target& target) {
  scene::Model model;
  model.set_file(file);
  if (!(surface.to_world == Transform{})) {
    set_matrix(surface.to_world, model.mutable_matrix());
  }
  model.set_material(material);
  if (surface.interior != nullptr) {
    ASSIGN_OR_RETURN(*model.mutable_interior(),
                     media_.medium_of(*surface.interior, surface.to_world));
    model.set_boundary_only(material.empty());
  } else if (material.empty()) {
    return error_at(from.place(), "has neither a surface nor a medium");
  }
  *target.models->Add() = std::move(model);
  return absl::OkStatus();
}

absl::Status ShapeReader::add_mesh(const Parameters& from, const Surface& surface,
                                   const Target& target) {
  MeshRequest request;
  request.type = from.object().type;
  ASSIGN_OR_RETURN(const std::string name, from.text("filename", ""));
  ASSIGN_OR_RETURN(request.file, to_.files.find(name));
  ASSIGN_OR_RETURN(request.index, from.integer("shape_index", 0));
  ASSIGN_OR_RETURN(request.flip_v, from.boolean("flip_tex_coords", request.type == "obj"));
  ASSIGN_OR_RETURN(request.face_normals, from.boolean("face_normals", false));
  if (from.has("max_smooth_angle")) {  // version 0.x
    to_.warn(from.place(), "\"max_smooth_angle\" is left out");
  }
  request.mirrored = determinant(surface.to_world) < 0;
  request.handed = needs_handedness(surface.bsdf);
  request.closed = surface.interior != nullptr;
  for (const Object* part : {surface.bsdf, surface.emitter}) {
    if (part != nullptr) {
      find_attributes(*part, request.attributes);
    }
  }
  // Whether the material turns its surface over does not depend on the mesh.
  ASSIGN_OR_RETURN(const SurfaceMaterial sides, materials_.sides_of(surface.bsdf));
  request.turned = surface.flip_normals != sides.turned;
  ASSIGN_OR_RETURN(const MeshFile file, meshes_.file_of(request));
  ASSIGN_OR_RETURN(const SurfaceMaterial material,
                   materials_.material_of(surface.bsdf, surface.emitter, file.surface));
  return add_model(from, surface, file.name, material.name, target);
}

absl::Status ShapeReader::add_made_mesh(const Parameters& from, const Surface& surface,
                                        SourceMesh mesh, const Target& target) {
  MeshRequest request;
  request.mirrored = determinant(surface.to_world) < 0;
  ASSIGN_OR_RETURN(const SurfaceMaterial sides, materials_.sides_of(surface.bsdf));
  request.turned = surface.flip_normals != sides.turned;
  ASSIGN_OR_RETURN(const MeshFile file, meshes_.made_of(std::move(mesh), request));
  ASSIGN_OR_RETURN(const SurfaceMaterial material,
                   materials_.material_of(surface.bsdf, surface.emitter, file.surface));
  return add_model(from, surface, file.name, material.name, target);
}

absl::Status ShapeReader::add_rectangle(const Parameters& from, const Surface& surface,
                                        const Target& target) {
  warn_of_interior(surface, from);
  Surface open = surface;
  open.interior = nullptr;
  if (is_null(surface.bsdf) && surface.emitter == nullptr) {
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(const SurfaceMaterial sides, materials_.sides_of(surface.bsdf));
  const bool turned = (surface.flip_normals != sides.turned) != (determinant(open.to_world) < 0);
  if (turned && needs_uv(surface.bsdf, surface.emitter)) {
    return add_made_mesh(from, open, rectangle_mesh(), target);
  }
  ASSIGN_OR_RETURN(const SurfaceMaterial material,
                   materials_.material_of(surface.bsdf, surface.emitter, {}));
  scene::Shape& shape = *target.shapes->Add();
  shape.set_material(material.name);
  // A turned rectangle starts at the corner (1, -1) and runs towards -x, so its normal is reversed.
  const double side = turned ? -1 : 1;
  add_numbers(open.to_world.point({-side, -1, 0}), shape.mutable_quad()->mutable_corner());
  add_numbers(open.to_world.direction({2 * side, 0, 0}), shape.mutable_quad()->mutable_u());
  add_numbers(open.to_world.direction({0, 2, 0}), shape.mutable_quad()->mutable_v());
  return absl::OkStatus();
}

absl::Status ShapeReader::add_placed(const scene::Shape& shape, const Transform& to_world,
                                     const Target& target) {
  const std::string name =
      absl::StrCat("placed ", shape.has_disk() ? "disk" : "sphere", " of ", shape.material(),
                   shape.interior().empty() ? "" : " with ", shape.interior());
  if (group_names_.insert(name).second) {
    scene::Group& group = *scene_.add_group();
    group.set_name(name);
    *group.add_shape() = shape;
  }
  scene::Instance& instance = *target.instances->Add();
  instance.set_of(name);
  set_matrix(to_world, instance.mutable_matrix());
  return absl::OkStatus();
}

absl::Status ShapeReader::add_disk(const Parameters& from, const Surface& surface,
                                   const Target& target) {
  warn_of_interior(surface, from);
  Surface open = surface;
  open.interior = nullptr;
  if (is_null(surface.bsdf) && surface.emitter == nullptr) {
    return absl::OkStatus();
  }
  if (needs_uv(surface.bsdf, surface.emitter)) {
    return add_made_mesh(from, open, disk_mesh(), target);
  }
  ASSIGN_OR_RETURN(const SurfaceMaterial material,
                   materials_.material_of(surface.bsdf, surface.emitter, {}));
  const double side = surface.flip_normals != material.turned ? -1 : 1;
  scene::Shape shape;
  shape.set_material(material.name);
  const Vec3 x = open.to_world.direction({1, 0, 0});
  const Vec3 y = open.to_world.direction({0, 1, 0});
  // True if the transform keeps the disk round. Any other disk becomes an instance of a unit disk.
  const bool round = std::abs(length(x) - length(y)) <= 1e-9 * length(x) &&
                     std::abs(dot(x, y)) <= 1e-9 * length_squared(x);
  shape.mutable_disk()->set_radius(round ? length(x) : 1);
  if (!round) {
    add_numbers({0, 0, side}, shape.mutable_disk()->mutable_normal());
    return add_placed(shape, open.to_world, target);
  }
  const double mirror = determinant(open.to_world) < 0 ? -1 : 1;
  add_numbers(open.to_world.point({}), shape.mutable_disk()->mutable_center());
  add_numbers(normalize(cross(x, y)) * (side * mirror), shape.mutable_disk()->mutable_normal());
  *target.shapes->Add() = std::move(shape);
  return absl::OkStatus();
}

absl::Status ShapeReader::add_sphere(const Parameters& from, const Surface& surface,
                                     const Target& target) {
  ASSIGN_OR_RETURN(const double radius, from.number("radius", 1));
  ASSIGN_OR_RETURN(const Vec3 center, from.vector("center", {}));
  if (!(radius > 0)) {
    return error_at(from.place(), "the radius of a sphere must be above 0");
  }
  Surface placed = surface;
  placed.to_world = surface.to_world * translation(center) * scaling({radius, radius, radius});
  ASSIGN_OR_RETURN(const SurfaceMaterial sides, materials_.sides_of(surface.bsdf));
  if (surface.flip_normals != sides.turned) {
    to_.warn(from.place(), "a sphere that is turned inside out is shown as a mesh");
    return add_made_mesh(from, placed, sphere_mesh(), target);
  }
  const bool uv = needs_uv(surface.bsdf, surface.emitter);
  // The poles and the seam of the uvs are at different places on Bandsaw's and Mitsuba's spheres.
  // The transform `axes` turns Bandsaw's sphere so that they coincide. Then the two spheres differ
  // only in the direction of v.
  const TexturedSurface textured{UvFrame::kFlipped, {}};
  ASSIGN_OR_RETURN(const SurfaceMaterial material,
                   materials_.material_of(surface.bsdf, surface.emitter, textured));
  scene::Shape shape;
  shape.set_material(material.name);
  const std::optional<double> scale = uniform_scale(placed.to_world);
  const bool is_instance = uv || !scale;
  const Transform axes{{{{-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}}}};
  const Transform to_world = is_instance ? placed.to_world * axes : Transform{};
  if (surface.interior != nullptr) {
    ASSIGN_OR_RETURN(*shape.mutable_interior(), media_.medium_of(*surface.interior, to_world));
  } else if (material.name.empty()) {
    return absl::OkStatus();
  }
  if (is_instance) {
    shape.mutable_sphere()->set_radius(1);
    return add_placed(shape, to_world, target);
  }
  add_numbers(placed.to_world.point({}), shape.mutable_sphere()->mutable_center());
  shape.mutable_sphere()->set_radius(*scale);
  *target.shapes->Add() = std::move(shape);
  return absl::OkStatus();
}

absl::Status ShapeReader::add_cylinder(const Parameters& from, const Surface& surface,
                                       const Target& target) {
  ASSIGN_OR_RETURN(const double radius, from.number("radius", 1));
  ASSIGN_OR_RETURN(const Vec3 p0, from.vector("p0", {0, 0, 0}));
  ASSIGN_OR_RETURN(const Vec3 p1, from.vector("p1", {0, 0, 1}));
  const Vec3 along = p1 - p0;
  if (!(length(along) > 0 && radius > 0)) {
    return error_at(from.place(), "a cylinder must have a radius and two different ends");
  }
  const Vec3 z = normalize(along);
  const Vec3 x = normalize(std::abs(z.x) > std::abs(z.y) ? Vec3{-z.z, 0, z.x} : Vec3{0, z.z, -z.y});
  const Vec3 y = cross(z, x);
  Surface open = surface;
  // A cylinder along z keeps its axes, so that its uvs begin where Mitsuba's do.
  const bool upright = z == Vec3{0, 0, 1};
  const Transform axes =
      upright ? Transform{}
              : Transform{{{{x.x, y.x, z.x, 0}, {x.y, y.y, z.y, 0}, {x.z, y.z, z.z, 0}}}};
  open.to_world =
      surface.to_world * translation(p0) * axes * scaling({radius, radius, length(along)});
  warn_of_interior(surface, from);
  open.interior = nullptr;
  return is_null(surface.bsdf) && surface.emitter == nullptr
             ? absl::OkStatus()
             : add_made_mesh(from, open, cylinder_mesh(), target);
}

absl::StatusOr<std::string> ShapeReader::group_of(const Object& group) {
  const auto known = groups_.find(&group);
  if (known != groups_.end()) {
    return known->second;
  }
  std::string name = group.id.empty() ? absl::StrCat("group ", groups_.size() + 1) : group.id;
  while (!group_names_.insert(name).second) {
    name += " again";
  }
  scene::Group out;
  out.set_name(name);
  const Parameters from(group);
  for (const Property* inside : from.objects("shape")) {
    RETURN_IF_ERROR(add_to(*object_in(*inside),
                           {out.mutable_shape(), out.mutable_model(), out.mutable_instance()}));
  }
  to_.warn_of_unused(from);
  if (out.shape().empty() && out.model().empty() && out.instance().empty()) {
    name.clear();  // nothing was added to the group
  } else {
    *scene_.add_group() = std::move(out);
  }
  groups_.emplace(&group, name);
  return name;
}

absl::Status ShapeReader::add_instance(const Parameters& from, const Target& target) {
  const auto groups = from.objects("shape");
  if (groups.empty() || object_in(*groups.front())->type != "shapegroup") {
    return error_at(from.place(), "an instance must refer to a shapegroup");
  }
  ASSIGN_OR_RETURN(const Transform to_world, from.transform("to_world"));
  if (!inverse(to_world)) {
    return error_at(from.place(), "to_world is singular: it flattens the instance");
  }
  ASSIGN_OR_RETURN(const std::string name, group_of(*object_in(*groups.front())));
  if (name.empty()) {
    return absl::OkStatus();
  }
  scene::Instance& instance = *target.instances->Add();
  instance.set_of(name);
  if (!(to_world == Transform{})) {
    set_matrix(to_world, instance.mutable_matrix());
  }
  return absl::OkStatus();
}

}  // namespace bandsaw::mitsuba
