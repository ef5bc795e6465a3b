#include "renderlib/package/check.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/light/check_light_counts.h"
#include "renderlib/light/check_lights.h"
#include "renderlib/package/manifest.h"
#include "renderlib/package/placements.h"
#include "renderlib/scene/check_counts.h"

namespace bandsaw {
namespace {

std::string text(const Vec3& v) { return absl::StrCat("[", v.x, ", ", v.y, ", ", v.z, "]"); }

absl::Status check_finite(const Vec3& v, const std::string& field) {
  return is_finite(v) ? absl::OkStatus()
                      : manifest_error(field, absl::StrCat("must be finite, is ", text(v)));
}

absl::Status check_background(const Background& background) {
  for (const Rgb& c : {background.bottom, background.top}) {
    if (!is_finite(c) || c.r < 0 || c.g < 0 || c.b < 0) {
      return manifest_error("background", absl::StrCat("must be finite and >= 0, has [", c.r, ", ",
                                                       c.g, ", ", c.b, "]"));
    }
  }
  return absl::OkStatus();
}

absl::Status check_local_shading(const LocalShading& local) {
  const Rgb& c = local.ambient;
  if (!is_finite(c) || c.r < 0 || c.g < 0 || c.b < 0) {
    return manifest_error(
        "ambient", absl::StrCat("must be finite and >= 0, has [", c.r, ", ", c.g, ", ", c.b, "]"));
  }
  if (!(local.occlusion_distance > 0)) {
    return manifest_error("occlusion_distance",
                          absl::StrCat("must be > 0, is ", local.occlusion_distance));
  }
  return absl::OkStatus();
}

absl::Status check_material_id(MaterialId id, std::size_t count, const std::string& field) {
  if (index_of(id) < count) {
    return absl::OkStatus();
  }
  return manifest_error(field,
                        absl::StrCat("is ", index_of(id), ", there are ", count, " materials"));
}

absl::Status check_disk(const Disk& disk, std::size_t i, std::size_t materials,
                        const std::string& prefix) {
  RETURN_IF_ERROR(check_finite(disk.center, absl::StrCat(prefix, "disks.centers[", i, "]")));
  if (!(std::isfinite(disk.radius) && disk.radius > 0)) {
    return manifest_error(absl::StrCat(prefix, "disks.radii[", i, "]"),
                          absl::StrCat("must be finite and > 0, is ", disk.radius));
  }
  if (!(std::abs(length(disk.normal) - 1) <= 1e-6)) {
    return manifest_error(absl::StrCat(prefix, "disks.normals[", i, "]"),
                          absl::StrCat("must have length 1, has ", length(disk.normal)));
  }
  return check_material_id(disk.material, materials,
                           absl::StrCat(prefix, "disks.material[", i, "]"));
}

absl::Status check_shapes(const Shapes& shapes, std::size_t materials, const std::string& prefix) {
  for (std::size_t i = 0; i < shapes.spheres.size(); ++i) {
    const Sphere& s = shapes.spheres[i];
    RETURN_IF_ERROR(check_finite(s.center, absl::StrCat(prefix, "spheres.centers[", i, "]")));
    if (!(std::isfinite(s.radius) && s.radius > 0)) {
      return manifest_error(absl::StrCat(prefix, "spheres.radii[", i, "]"),
                            absl::StrCat("must be finite and > 0, is ", s.radius));
    }
    RETURN_IF_ERROR(check_material_id(s.material, materials,
                                      absl::StrCat(prefix, "spheres.material[", i, "]")));
  }
  for (std::size_t i = 0; i < shapes.quads.size(); ++i) {
    const Quad& q = shapes.quads[i];
    RETURN_IF_ERROR(check_finite(q.corner, absl::StrCat(prefix, "quads.corners[", i, "]")));
    RETURN_IF_ERROR(check_finite(q.u, absl::StrCat(prefix, "quads.u[", i, "]")));
    RETURN_IF_ERROR(check_finite(q.v, absl::StrCat(prefix, "quads.v[", i, "]")));
    RETURN_IF_ERROR(
        check_material_id(q.material, materials, absl::StrCat(prefix, "quads.material[", i, "]")));
  }
  for (std::size_t i = 0; i < shapes.triangles.size(); ++i) {
    const Triangle& t = shapes.triangles[i];
    for (const Vec3& vertex : {t.a, t.b, t.c}) {
      RETURN_IF_ERROR(check_finite(vertex, absl::StrCat(prefix, "triangles.vertices[", i, "]")));
    }
    RETURN_IF_ERROR(check_material_id(t.material, materials,
                                      absl::StrCat(prefix, "triangles.material[", i, "]")));
  }
  for (std::size_t i = 0; i < shapes.disks.size(); ++i) {
    RETURN_IF_ERROR(check_disk(shapes.disks[i], i, materials, prefix));
  }
  return absl::OkStatus();
}

// Per-vertex arrays: positions, normals, uvs.
template <std::size_t N>
absl::Status check_floats(const std::vector<std::array<float, N>>& values,
                          const std::string& field) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const float value : values[i]) {
      if (!std::isfinite(value)) {
        return manifest_error(absl::StrCat(field, "[", i, "]"),
                              absl::StrCat("must be finite, is ", value));
      }
    }
  }
  return absl::OkStatus();
}

absl::Status check_mesh(const Mesh& mesh, const std::string& field) {
  const std::size_t vertices = mesh.positions.size();
  RETURN_IF_ERROR(check_floats(mesh.positions, field + ".positions"));
  RETURN_IF_ERROR(check_floats(mesh.normals, field + ".normals"));
  RETURN_IF_ERROR(check_floats(mesh.uvs, field + ".uvs"));
  RETURN_IF_ERROR(check_floats(mesh.uvs2, field + ".uvs2"));
  RETURN_IF_ERROR(check_floats(mesh.colors, field + ".colors"));
  for (const std::array<float, 3>& color : mesh.colors) {
    if (color[0] < 0 || color[1] < 0 || color[2] < 0) {
      return manifest_error(field + ".colors", "must not be negative");
    }
  }
  if (!mesh.colors.empty() && mesh.colors.size() != vertices) {
    return manifest_error(field + ".colors", absl::StrCat("has ", mesh.colors.size(),
                                                          " entries for ", vertices, " vertices"));
  }
  if (!mesh.normals.empty() && mesh.normals.size() != vertices) {
    return manifest_error(field + ".normals", absl::StrCat("has ", mesh.normals.size(),
                                                           " entries for ", vertices, " vertices"));
  }
  if (!mesh.uvs.empty() && mesh.uvs.size() != vertices) {
    return manifest_error(field + ".uvs", absl::StrCat("has ", mesh.uvs.size(), " entries for ",
                                                       vertices, " vertices"));
  }
  if (!mesh.uvs2.empty() && mesh.uvs2.size() != vertices) {
    return manifest_error(field + ".uvs2", absl::StrCat("has ", mesh.uvs2.size(), " entries for ",
                                                        vertices, " vertices"));
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t index : mesh.triangles[i]) {
      if (index >= vertices) {
        return manifest_error(absl::StrCat(field, ".indices[", i, "]"),
                              absl::StrCat("is ", index, ", the mesh has ", vertices, " vertices"));
      }
    }
  }
  return absl::OkStatus();
}

/// An error of a check that is not about packages alone.
absl::Status of_package(const absl::Status& status) {
  return status.ok()
             ? status
             : absl::InvalidArgumentError(absl::StrCat("scene package: ", status.message()));
}

}  // namespace

absl::Status check_description(const SceneDescription& scene) {
  if (const absl::Status camera = validate(scene.camera); !camera.ok()) {
    return manifest_error("camera", std::string(camera.message()));
  }
  if (const absl::Status filter = validate(scene.filter); !filter.ok()) {
    return manifest_error("filter", std::string(filter.message()));
  }
  RETURN_IF_ERROR(check_local_shading(scene.local_shading));
  RETURN_IF_ERROR(check_background(scene.background));
  RETURN_IF_ERROR(check_materials(scene));
  if (const absl::Status lights = check_lights(scene.background, scene.textures, scene.lights);
      !lights.ok()) {
    return manifest_error("lights", std::string(lights.message()));
  }
  const Geometry& geometry = scene.geometry;
  RETURN_IF_ERROR(of_package(check_geometry_counts("", geometry)));
  RETURN_IF_ERROR(check_shapes(geometry, scene.materials.size(), ""));
  for (std::size_t i = 0; i < geometry.meshes.size(); ++i) {
    RETURN_IF_ERROR(check_mesh(geometry.meshes[i], absl::StrCat("mesh[", i, "]")));
  }
  for (std::size_t i = 0; i < geometry.groups.size(); ++i) {
    RETURN_IF_ERROR(
        check_shapes(geometry.groups[i], scene.materials.size(), absl::StrCat("group[", i, "].")));
  }
  RETURN_IF_ERROR(check_placements(geometry, scene.materials.size()));
  RETURN_IF_ERROR(of_package(
      check_light_counts(geometry, scene.materials, scene.textures, scene.lights.size())));
  return of_package(validate(scene.media));
}

}  // namespace bandsaw
