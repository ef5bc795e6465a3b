// Converts pbrt's shapes. Whole spheres and disks whose uvs do not matter become shapes of our
// scene. A PLY file of the scene is used unchanged if is_plain_file() allows it. All other shapes
// become meshes in made files: PLY files that the converter makes and adds to the scene. Each shape
// is placed with its material, emission, opacity and the medium inside.

#include <algorithm>
#include <cmath>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/pbrt/builder.h"
#include "renderlib/import/pbrt/mesh_shapes.h"
#include "renderlib/import/pbrt/motion.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw::pbrt {
namespace {

/// Returns the factor by which `t` scales lengths; std::nullopt if `t` does not keep angles.
std::optional<double> uniform_scale(const Transform& t) {
  const Vec3 x = t.direction({1, 0, 0});
  const Vec3 y = t.direction({0, 1, 0});
  const Vec3 z = t.direction({0, 0, 1});
  const double s = length(x);
  const double limit = 1e-6 * s * s;
  const bool keeps = std::abs(length(y) - s) <= 1e-6 * s && std::abs(length(z) - s) <= 1e-6 * s &&
                     std::abs(dot(x, y)) <= limit && std::abs(dot(y, z)) <= limit &&
                     std::abs(dot(z, x)) <= limit;
  return keeps && s > 0 ? std::optional(s) : std::nullopt;
}

bool is_moving(const State& state) { return !(state.transforms[0] == state.transforms[1]); }

/// Returns true if the material looks different with other uvs.
bool depends_on_uvs(const scene::Material& material) {
  // If a texture is not constant, the material refers to it in a field `use`.
  return material.ShortDebugString().find("use:") != std::string::npos || material.has_mix() ||
         material.has_normal_texture() || material.gltf().has_normal_texture() ||
         material.conductor().surface().has_alpha_v() ||
         material.dielectric().surface().has_alpha_v();
}

/// A Shape directive, and what its emission and alpha add to the material.
struct Shape {
  const std::string& type;
  const Parameters& parameters;
  const State& state;
  Builder& builder;
  ShapeLook look = {};
  const Place& place() const { return parameters.place; }
};

/// The names of the media on both sides of a surface; empty: none.
struct Sides {
  std::string inside;
  std::string outside;
  bool differ() const { return inside != outside; }
};

/// Returns the name of the medium inside a closed shape. The name is empty if the shape needs no
/// medium of its own, or if the medium has no counterpart. If there is a medium outside but none
/// inside, the name is that of the vacuum. `to_shape` maps the world to the space in which the
/// shape is written.
absl::StatusOr<std::string> interior_of(const Shape& shape, const Sides& sides,
                                        const Transform& to_shape) {
  if (!sides.differ() || !shape.state.surface->transmits) {
    return std::string();
  }
  if (sides.inside.empty()) {
    shape.builder.needs_vacuum = true;
    return std::string(kVacuum);
  }
  return medium_name(sides.inside, shape.place(), to_shape, shape.builder);
}

/// Adds the sphere or disk `local`, which is written in the shape's own space, to a group of its
/// own. An instance of this group is placed by the shape's transformations.
void add_local(const Shape& shape, const scene::Shape& local) {
  std::string name;
  *add_helper_group(shape.builder, name).add_shape() = local;
  scene::Instance instance;
  instance.set_of(name);
  add_placed(shape.place(), shape.state.transforms, std::move(instance), shape.builder);
}

/// Adds the sphere or disk `world`, which is written in world space.
void add_world(const Shape& shape, scene::Shape world) {
  Builder& builder = shape.builder;
  *(builder.group != nullptr ? builder.group->add_shape() : builder.out.add_shape()) =
      std::move(world);
}

/// Sets the names of the shape's material and of the medium inside, which is `interior`. An
/// invisible surface has no material unless it emits. Returns false if nothing is left of the
/// shape.
bool finish(const Shape& shape, const std::string& interior, std::string* material,
            std::string* to_interior) {
  const Surface& surface = *shape.state.surface;
  if (surface.is_null && interior.empty() && !shape.look.emission && !shape.look.emission_texture) {
    return false;
  }
  if (!surface.is_null || shape.look.emission || shape.look.emission_texture) {
    Surface shown = surface;
    if (surface.is_null) {
      shown.is_black = true;
      shown.label = "light";
    }
    *material = material_name(shown, shape.look, shape.place(), shape.builder);
  }
  *to_interior = interior;
  return true;
}

/// Adds the box from `low` to `high` in the shape's space to the extent of the scene.
void extend(const Shape& shape, const Vec3& low, const Vec3& high) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p{(corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                 (corner & 4) != 0 ? high.z : low.z};
    shape.builder.extent.add(shape.state.transforms[0].point(p));
  }
}

/// Adds a whole sphere: in world space if it does not move and its transformation keeps angles,
/// otherwise as an instance of a group.
absl::Status add_sphere(const Shape& shape, double radius, const Sides& sides) {
  extend(shape, {-radius, -radius, -radius}, {radius, radius, radius});
  const Transform& to_world = shape.state.transforms[0];
  const auto scale = uniform_scale(to_world);
  const bool is_local = !scale || is_moving(shape.state);
  const Transform to_shape = is_local ? inverse(to_world).value_or(Transform{}) : Transform{};
  ASSIGN_OR_RETURN(const std::string interior, interior_of(shape, sides, to_shape));
  scene::Shape out;
  if (!finish(shape, interior, out.mutable_material(), out.mutable_interior())) {
    return absl::OkStatus();
  }
  scene::Sphere& sphere = *out.mutable_sphere();
  sphere.set_radius(is_local ? radius : radius * *scale);
  if (is_local) {
    add_local(shape, out);
  } else {
    set_vec3(to_world.point({0, 0, 0}), sphere.mutable_center());
    add_world(shape, std::move(out));
  }
  return absl::OkStatus();
}

/// Adds a whole disk: in world space if it does not move and its transformation keeps angles,
/// otherwise as an instance of a group.
void add_disk(const Shape& shape, double radius, double height) {
  extend(shape, {-radius, -radius, height}, {radius, radius, height});
  const Transform& to_world = shape.state.transforms[0];
  const auto scale = uniform_scale(to_world);
  const bool is_local = !scale || is_moving(shape.state);
  scene::Shape out;
  std::string unused;
  if (!finish(shape, "", out.mutable_material(), &unused)) {
    return;
  }
  const double side = shape.state.reverse_orientation ? -1 : 1;
  scene::Disk& disk = *out.mutable_disk();
  if (is_local) {
    set_vec3({0, 0, height}, disk.mutable_center());
    set_vec3({0, 0, side}, disk.mutable_normal());
    disk.set_radius(radius);
    add_local(shape, out);
    return;
  }
  set_vec3(to_world.point({0, 0, height}), disk.mutable_center());
  set_vec3(to_world.direction({0, 0, side}), disk.mutable_normal());
  disk.set_radius(radius * *scale);
  add_world(shape, std::move(out));
}

/// Remembers the media on both sides of an open surface, for finish_media().
void note_open_medium(const Shape& shape, const Sides& sides) {
  if (sides.differ() && shape.state.surface->transmits) {
    for (const std::string& medium : {sides.inside, sides.outside}) {
      if (!medium.empty()) {
        shape.builder.open_media.emplace(medium, shape.place());
      }
    }
  }
}

/// Adds the mesh in `file`, which is a made file or a PLY file of the scene. Only a mesh that is
/// `closed` can have a medium inside.
absl::Status add_model(const Shape& shape, const std::string& file, bool closed,
                       const Sides& sides) {
  const Transform& to_world = shape.state.transforms[0];
  std::string interior;
  if (closed) {
    ASSIGN_OR_RETURN(interior, interior_of(shape, sides, inverse(to_world).value_or(Transform{})));
  } else {
    note_open_medium(shape, sides);
  }
  scene::Model model;
  if (!finish(shape, interior, model.mutable_material(), model.mutable_interior())) {
    return absl::OkStatus();
  }
  if (model.material().empty()) {
    model.set_boundary_only(true);
  }
  model.set_file(file);
  add_placed(shape.place(), shape.state.transforms, std::move(model), shape.builder);
  return absl::OkStatus();
}

double area_of(const PlyMesh& mesh, const Transform& to_world) {
  double area = 0;
  const auto at = [&](std::uint32_t v) {
    const auto& p = mesh.positions[v];
    return to_world.point({p[0], p[1], p[2]});
  };
  for (const auto& t : mesh.triangles) {
    area += length(cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]))) / 2;
  }
  return area;
}

/// Reads the AreaLightSource, and sets the emission of `shape.look`. `area` is the area of the
/// shape in world space.
absl::Status read_emission(Shape& shape, double area) {
  Builder& builder = shape.builder;
  const Parameters& in = shape.state.area_light->parameters;
  ASSIGN_OR_RETURN(Rgb3 radiance,
                   color(in, "L", ColorUse::kLight, {1, 1, 1}, shape.state, builder));
  ASSIGN_OR_RETURN(double scale, in.number("scale", 1));
  ASSIGN_OR_RETURN(const double power, in.number("power", -1));
  ASSIGN_OR_RETURN(shape.look.emits_on_both_sides, in.boolean("twosided", false));
  ASSIGN_OR_RETURN(std::string file, in.text("filename", ""));
  ASSIGN_OR_RETURN(const std::string own, shape.parameters.text("emissionfilename", ""));
  file = own.empty() ? file : own;
  if (power > 0 && area > 0) {
    // A side that emits a radiance of luminance y in all directions has the power y * area * pi.
    const double y = std::max(spectrum::luminance(radiance), 1e-12);
    scale *= power / (y * area * kPi * (shape.look.emits_on_both_sides ? 2 : 1));
  }
  for (double& channel : radiance) {
    channel = std::max(0.0, channel * scale * builder.light_factor);
  }
  if (!file.empty()) {
    ASSIGN_OR_RETURN(const auto bytes,
                     read_or_warn(file, shape.place(), "the light is uniform", builder));
    if (bytes) {
      scene::Texture texture;
      auto* product = texture.mutable_product();
      product->mutable_a()->mutable_image()->set_file(file);
      *product->mutable_b() = constant_texture(radiance);
      shape.look.emission_texture = std::move(texture);
      return absl::OkStatus();
    }
  }
  shape.look.emission = radiance;
  return absl::OkStatus();
}

/// Returns true if a PLY file can be used unchanged: the shape is not reversed, emits no light and
/// transmits none, and the medium is the same on both sides.
bool is_plain_file(const Shape& shape, const std::string& file, const Sides& sides) {
  return absl::EndsWithIgnoreCase(file, ".ply") && !shape.state.reverse_orientation &&
         shape.state.area_light == nullptr && !shape.state.surface->transmits && !sides.differ();
}

/// Adds the shape as a mesh: as the scene's PLY file if that file can be used unchanged, otherwise
/// as a made file.
absl::Status add_mesh(Shape& shape, Sides sides) {
  ASSIGN_OR_RETURN(const std::string file, shape.parameters.text("filename", ""));
  if (shape.type == "plymesh") {
    shape.parameters.ignore({"edgelength"});
    if (is_plain_file(shape, file, sides)) {
      ASSIGN_OR_RETURN(const auto bytes,
                       read_or_warn(file, shape.place(), "the shape is left out", shape.builder));
      if (!bytes) {
        return absl::OkStatus();
      }
      shape.builder.unchanged_files.push_back({shape.parameters, shape.state.transforms[0]});
      return add_model(shape, file, /*closed=*/false, sides);
    }
  }
  ASSIGN_OR_RETURN(auto mesh, mesh_of(shape.type, shape.parameters, shape.builder));
  if (!mesh) {
    return absl::OkStatus();
  }
  if (shape.state.reverse_orientation) {
    reverse(*mesh);
  }
  for (const auto& p : mesh->positions) {
    shape.builder.extent.add(shape.state.transforms[0].point({p[0], p[1], p[2]}));
  }
  if (shape.state.area_light != nullptr) {
    RETURN_IF_ERROR(read_emission(shape, area_of(*mesh, shape.state.transforms[0])));
  }
  const bool needs_volume = sides.differ() && shape.state.surface->transmits;
  const bool closed = needs_volume && is_closed(*mesh);
  // If the triangles face inwards, the enclosed side is the one that pbrt calls outside.
  if (closed && signed_volume(*mesh) < 0) {
    std::swap(sides.inside, sides.outside);
  }
  return add_model(shape, shape.builder.made.add("mesh", ".ply", write_ply(*mesh)), closed, sides);
}

/// Returns true if the shape looks different with other uvs: by its surface, by its alpha, or by
/// the image of its light. Bandsaw's spheres and disks have other uvs than pbrt's, so only a mesh
/// can have pbrt's uvs.
absl::StatusOr<bool> depends_on_uvs(const Shape& shape) {
  if (depends_on_uvs(shape.state.surface->material) ||
      (shape.look.opacity && !constant_of(*shape.look.opacity))) {
    return true;
  }
  if (shape.state.area_light == nullptr) {
    return false;
  }
  ASSIGN_OR_RETURN(const std::string image,
                   shape.state.area_light->parameters.text("filename", ""));
  ASSIGN_OR_RETURN(const std::string own, shape.parameters.text("emissionfilename", ""));
  return !image.empty() || !own.empty();
}

/// Adds a whole sphere or disk as a shape of our scene. Returns false, and adds nothing, if the
/// shape must be a mesh.
absl::StatusOr<bool> add_whole_quadric(Shape& shape, Sides sides) {
  const Parameters& in = shape.parameters;
  if (shape.type != "sphere" && shape.type != "disk") {
    return false;
  }
  ASSIGN_OR_RETURN(const double r, in.number("radius", 1));
  ASSIGN_OR_RETURN(const double phi, in.number("phimax", 360));
  if (!(r > 0 && r < 1e30)) {
    return error_at(in.place, absl::StrCat("\"radius\" must be > 0, is ", r));
  }
  const double volume = std::abs(determinant(shape.state.transforms[0]));
  const double scale = volume > 0 ? pow(volume, 1.0 / 3) : 0;  // mean over the three axes
  const bool is_sphere = shape.type == "sphere";
  ASSIGN_OR_RETURN(const double zmin, in.number("zmin", -r));
  ASSIGN_OR_RETURN(const double zmax, in.number("zmax", r));
  ASSIGN_OR_RETURN(const double inner, in.number("innerradius", 0));
  ASSIGN_OR_RETURN(const double height, in.number("height", 0));
  const bool is_whole =
      phi >= 360 &&
      (is_sphere ? std::min(zmin, zmax) <= -r && std::max(zmin, zmax) >= r : inner <= 0);
  const bool emits = shape.state.area_light != nullptr;
  ASSIGN_OR_RETURN(const bool needs_uvs, depends_on_uvs(shape));
  if (!is_whole || needs_uvs || (is_sphere && emits && shape.state.reverse_orientation)) {
    return false;
  }
  if (emits) {
    RETURN_IF_ERROR(read_emission(shape, kPi * r * r * scale * scale * (is_sphere ? 4 : 1)));
  }
  if (is_sphere) {
    if (shape.state.reverse_orientation) {
      std::swap(sides.inside, sides.outside);
    }
    RETURN_IF_ERROR(add_sphere(shape, r, sides));
  } else {
    note_open_medium(shape, sides);
    add_disk(shape, r, height);
  }
  return true;
}

}  // namespace

absl::Status add_shape(const std::string& type, const Parameters& parameters, const State& state,
                       Builder& builder) {
  Shape shape{type, parameters, state, builder};
  if (!inverse(state.transforms[0]) || !inverse(state.transforms[1])) {
    return error_at(parameters.place, "the transformation of the shape is singular");
  }
  builder.has_motion = builder.has_motion || is_moving(state);
  if (type == "curve") {
    builder.warn_once(parameters.place, "curves have no counterpart and are left out");
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(auto alpha, float_texture(parameters, "alpha", builder));
  if (alpha) {
    ASSIGN_OR_RETURN(alpha, limited(*std::move(alpha), parameters.place, builder));
  }
  if (alpha && constant_of(*alpha) != 1.0) {
    shape.look.opacity = std::move(alpha);
  }
  if (shape.look.opacity && constant_of(*shape.look.opacity) == 0.0) {
    builder.warn(parameters.place, "a shape with an alpha of 0 is left out; it does not emit");
    return absl::OkStatus();
  }
  const Sides sides{state.inside, state.outside};
  ASSIGN_OR_RETURN(const bool is_done, add_whole_quadric(shape, sides));
  if (!is_done) {
    RETURN_IF_ERROR(add_mesh(shape, sides));
  }
  builder.warn_of_unused(parameters);
  return absl::OkStatus();
}

}  // namespace bandsaw::pbrt
