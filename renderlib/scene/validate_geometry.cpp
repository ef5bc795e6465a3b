#include "renderlib/scene/validate_geometry.h"

#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/scene/validate.h"
#include "renderlib/scene/validate_field.h"

namespace bandsaw {
namespace {

/// What a unit normal may be off by: it is normalised again where that matters.
constexpr double kUnitSlack = 1e-6;

absl::Status check_disk(const std::string& field, const Disk& disk, std::size_t materials) {
  RETURN_IF_ERROR(check_point(field + ".center", disk.center));
  if (!(disk.radius > 0)) {
    return invalid(field + ".radius", absl::StrCat("must be > 0, is ", disk.radius));
  }
  RETURN_IF_ERROR(check_point(field + ".radius", {disk.radius, 0, 0}));
  if (!(std::abs(length(disk.normal) - 1) <= kUnitSlack)) {
    return invalid(field + ".normal",
                   absl::StrCat("must have length 1, has ", length(disk.normal)));
  }
  return check_index(field + ".material", disk.material, materials);
}

absl::Status check_shapes(const std::string& where, const Shapes& shapes, std::size_t materials) {
  for (std::size_t i = 0; i < shapes.spheres.size(); ++i) {
    const Sphere& sphere = shapes.spheres[i];
    const std::string field = where + item("spheres", i);
    RETURN_IF_ERROR(check_point(field + ".center", sphere.center));
    if (!(sphere.radius > 0)) {
      return invalid(field + ".radius", absl::StrCat("must be > 0, is ", sphere.radius));
    }
    RETURN_IF_ERROR(check_point(field + ".radius", {sphere.radius, 0, 0}));
    RETURN_IF_ERROR(check_index(field + ".material", sphere.material, materials));
  }
  for (std::size_t i = 0; i < shapes.quads.size(); ++i) {
    const Quad& quad = shapes.quads[i];
    const std::string field = where + item("quads", i);
    RETURN_IF_ERROR(check_point(field + ".corner", quad.corner));
    RETURN_IF_ERROR(check_point(field + ".u", quad.u));
    RETURN_IF_ERROR(check_point(field + ".v", quad.v));
    RETURN_IF_ERROR(check_index(field + ".material", quad.material, materials));
  }
  for (std::size_t i = 0; i < shapes.triangles.size(); ++i) {
    const Triangle& triangle = shapes.triangles[i];
    const std::string field = where + item("triangles", i);
    RETURN_IF_ERROR(check_point(field + ".a", triangle.a));
    RETURN_IF_ERROR(check_point(field + ".b", triangle.b));
    RETURN_IF_ERROR(check_point(field + ".c", triangle.c));
    RETURN_IF_ERROR(check_index(field + ".material", triangle.material, materials));
  }
  for (std::size_t i = 0; i < shapes.disks.size(); ++i) {
    RETURN_IF_ERROR(check_disk(where + item("disks", i), shapes.disks[i], materials));
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

absl::Status check_placement(const std::string& field, const Transform& placement) {
  for (const auto& row : placement.m) {
    for (const double entry : row) {
      if (!(std::abs(entry) <= kMaxCoordinate)) {
        return invalid(field, absl::StrCat("entries must be within +-", kMaxCoordinate,
                                           ", one is ", entry));
      }
    }
  }
  if (!inverse(placement)) {
    return invalid(field, "must have an inverse (it scales by 0, or by too different factors)");
  }
  return absl::OkStatus();
}

absl::Status check_instance(const std::string& field, const Instance& instance,
                            const SceneDescription& scene) {
  const Geometry& geometry = scene.geometry;
  if (instance.group == kNoGroup) {
    RETURN_IF_ERROR(check_index(field + ".mesh", instance.mesh, geometry.meshes.size()));
  } else {
    RETURN_IF_ERROR(check_index(field + ".group", instance.group, geometry.groups.size()));
  }
  if (instance.group == kNoGroup || instance.material != kOwnMaterial) {
    RETURN_IF_ERROR(check_index(field + ".material", instance.material, scene.materials.size()));
  }
  if (instance.frame != kNoFrame) {
    RETURN_IF_ERROR(check_index(field + ".frame", instance.frame, geometry.frames.size()));
  }
  return check_placement(field + ".to_world", instance.to_world);
}

absl::Status check_frame(const std::string& field, const Frame& frame, std::size_t number) {
  if (frame.parent != kNoFrame) {
    RETURN_IF_ERROR(check_index(field + ".parent", frame.parent, number));
  }
  RETURN_IF_ERROR(check_placement(field + ".placement", frame.placement));
  if (frame.keys.empty()) {
    return invalid(field + ".keys", "must be one at least");
  }
  for (std::size_t i = 0; i < frame.keys.size(); ++i) {
    const Key& key = frame.keys[i];
    const std::string name = absl::StrCat(field, ".keys[", i, "]");
    if (!(std::abs(key.time) <= kMostTime) || (i > 0 && !(key.time > frame.keys[i - 1].time))) {
      return invalid(name + ".time", absl::StrCat("must be within +-1e9 and rise, is ", key.time));
    }
    RETURN_IF_ERROR(check_placement(name + ".at", key.at));
    if (!decompose(key.at)) {
      return invalid(name + ".at", "must be a scale, then a rotation, then a translation: it shears");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status check_geometry(const SceneDescription& scene) {
  const Geometry& geometry = scene.geometry;
  RETURN_IF_ERROR(check_shapes("", geometry, scene.materials.size()));
  for (std::size_t i = 0; i < geometry.groups.size(); ++i) {
    RETURN_IF_ERROR(
        check_shapes(item("groups", i) + ".", geometry.groups[i], scene.materials.size()));
  }
  for (std::size_t i = 0; i < geometry.meshes.size(); ++i) {
    RETURN_IF_ERROR(check_mesh(item("meshes", i), geometry.meshes[i]));
  }
  for (std::size_t i = 0; i < geometry.frames.size(); ++i) {
    RETURN_IF_ERROR(check_frame(item("frames", i), geometry.frames[i], i));
  }
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    RETURN_IF_ERROR(check_instance(item("instances", i), geometry.instances[i], scene));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
