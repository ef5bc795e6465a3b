#include "renderlib/scene/validate.h"

#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/scene/validate_field.h"

namespace bandsaw {
namespace {

absl::Status check_camera(const Camera& camera) {
  RETURN_IF_ERROR(validate(camera));
  RETURN_IF_ERROR(check_point("camera.position", view_of(camera).position));
  return check_point("camera.look_at", view_of(camera).look_at);
}

absl::Status check_local_shading(const LocalShading& local) {
  RETURN_IF_ERROR(
      check_color("local_shading.ambient", local.ambient, static_cast<float>(kInfinity)));
  if (!(local.occlusion_distance > 0)) {
    return invalid("local_shading.occlusion_distance",
                   absl::StrCat("must be > 0, is ", local.occlusion_distance));
  }
  return absl::OkStatus();
}

absl::Status check_shapes(const Geometry& geometry, std::size_t materials) {
  for (std::size_t i = 0; i < geometry.spheres.size(); ++i) {
    const Sphere& sphere = geometry.spheres[i];
    const std::string field = item("spheres", i);
    RETURN_IF_ERROR(check_point(field + ".center", sphere.center));
    if (!(sphere.radius > 0)) {
      return invalid(field + ".radius", absl::StrCat("must be > 0, is ", sphere.radius));
    }
    RETURN_IF_ERROR(check_point(field + ".radius", {sphere.radius, 0, 0}));
    RETURN_IF_ERROR(check_index(field + ".material", sphere.material, materials));
  }
  for (std::size_t i = 0; i < geometry.quads.size(); ++i) {
    const Quad& quad = geometry.quads[i];
    const std::string field = item("quads", i);
    RETURN_IF_ERROR(check_point(field + ".corner", quad.corner));
    RETURN_IF_ERROR(check_point(field + ".u", quad.u));
    RETURN_IF_ERROR(check_point(field + ".v", quad.v));
    RETURN_IF_ERROR(check_index(field + ".material", quad.material, materials));
  }
  for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
    const Triangle& triangle = geometry.triangles[i];
    const std::string field = item("triangles", i);
    RETURN_IF_ERROR(check_point(field + ".a", triangle.a));
    RETURN_IF_ERROR(check_point(field + ".b", triangle.b));
    RETURN_IF_ERROR(check_point(field + ".c", triangle.c));
    RETURN_IF_ERROR(check_index(field + ".material", triangle.material, materials));
  }
  return absl::OkStatus();
}

absl::Status check_mesh(const std::string& field, const Mesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  if (!mesh.normals.empty() && mesh.normals.size() != vertices) {
    return invalid(field + ".normals", absl::StrCat("must be none or one a position (", vertices,
                                                    "), are ", mesh.normals.size()));
  }
  if (!mesh.uvs.empty() && mesh.uvs.size() != vertices) {
    return invalid(field + ".uvs", absl::StrCat("must be none or one a position (", vertices,
                                                "), are ", mesh.uvs.size()));
  }
  if (!mesh.uvs2.empty() && mesh.uvs2.size() != vertices) {
    return invalid(field + ".uvs2", absl::StrCat("must be none or one a position (", vertices,
                                                 "), are ", mesh.uvs2.size()));
  }
  if (!mesh.colors.empty() && mesh.colors.size() != vertices) {
    return invalid(field + ".colors", absl::StrCat("must be none or one a position (", vertices,
                                                   "), are ", mesh.colors.size()));
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t index : mesh.triangles[i]) {
      if (index >= vertices) {
        return invalid(absl::StrCat(field, ".triangles[", i, "]"),
                       absl::StrCat("must be indices below ", vertices, ", one is ", index));
      }
    }
  }
  return absl::OkStatus();
}

absl::Status check_instance(const std::string& field, const Instance& instance,
                            const SceneDescription& scene) {
  RETURN_IF_ERROR(check_index(field + ".mesh", instance.mesh, scene.geometry.meshes.size()));
  RETURN_IF_ERROR(check_index(field + ".material", instance.material, scene.materials.size()));
  for (const auto& row : instance.to_world.m) {
    for (const double entry : row) {
      if (!(std::abs(entry) <= kMaxCoordinate)) {
        return invalid(field + ".to_world", absl::StrCat("entries must be within +-",
                                                         kMaxCoordinate, ", one is ", entry));
      }
    }
  }
  if (!inverse(instance.to_world)) {
    return invalid(field + ".to_world",
                   "must have an inverse (it scales by 0, or by too different factors)");
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status validate(const SceneDescription& scene) {
  RETURN_IF_ERROR(check_camera(scene.camera));
  RETURN_IF_ERROR(validate(scene.filter));
  RETURN_IF_ERROR(check_local_shading(scene.local_shading));
  const auto infinite = static_cast<float>(kInfinity);
  RETURN_IF_ERROR(check_color("background.bottom", scene.background.bottom, infinite));
  RETURN_IF_ERROR(check_color("background.top", scene.background.top, infinite));
  RETURN_IF_ERROR(check_surfaces(scene));
  const Geometry& geometry = scene.geometry;
  RETURN_IF_ERROR(check_shapes(geometry, scene.materials.size()));
  for (std::size_t i = 0; i < geometry.meshes.size(); ++i) {
    RETURN_IF_ERROR(check_mesh(item("meshes", i), geometry.meshes[i]));
  }
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    RETURN_IF_ERROR(check_instance(item("instances", i), geometry.instances[i], scene));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
