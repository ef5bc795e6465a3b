// Checks the shapes, meshes, groups, frames and instances of a scene, one entry after the other.
// Errors name the path of the field.

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/scene/check_counts.h"
#include "renderlib/scene/validate.h"
#include "renderlib/scene/validate_field.h"

namespace bandsaw {
namespace {

/// Maximum difference between the length of a unit normal and 1. Code that needs a more exact
/// length normalises the normals again.
constexpr double kUnitSlack = 1e-6;

absl::Status check_radius(const std::string& field, double radius) {
  if (!(radius > 0)) {
    return invalid(field, absl::StrCat("must be > 0, is ", radius));
  }
  return check_point(field, {radius, 0, 0});
}

absl::Status check_shape(const std::string& field, const Sphere& sphere) {
  RETURN_IF_ERROR(check_point(field + ".center", sphere.center));
  return check_radius(field + ".radius", sphere.radius);
}

absl::Status check_shape(const std::string& field, const Quad& quad) {
  RETURN_IF_ERROR(check_point(field + ".corner", quad.corner));
  RETURN_IF_ERROR(check_point(field + ".u", quad.u));
  return check_point(field + ".v", quad.v);
}

absl::Status check_shape(const std::string& field, const Triangle& triangle) {
  RETURN_IF_ERROR(check_point(field + ".a", triangle.a));
  RETURN_IF_ERROR(check_point(field + ".b", triangle.b));
  return check_point(field + ".c", triangle.c);
}

absl::Status check_shape(const std::string& field, const Disk& disk) {
  RETURN_IF_ERROR(check_point(field + ".center", disk.center));
  RETURN_IF_ERROR(check_radius(field + ".radius", disk.radius));
  if (!(std::abs(length(disk.normal) - 1) <= kUnitSlack)) {
    return invalid(field + ".normal",
                   absl::StrCat("must have length 1, has ", length(disk.normal)));
  }
  return absl::OkStatus();
}

template <class Shape>
absl::Status check_list(const std::string& list, const std::vector<Shape>& shapes,
                        std::size_t materials) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::string field = item(list, i);
    RETURN_IF_ERROR(check_shape(field, shapes[i]));
    RETURN_IF_ERROR(check_index(field + ".material", shapes[i].material, materials));
  }
  return absl::OkStatus();
}

absl::Status check_shapes(const std::string& where, const Shapes& shapes, std::size_t materials) {
  RETURN_IF_ERROR(check_list(where + "spheres", shapes.spheres, materials));
  RETURN_IF_ERROR(check_list(where + "quads", shapes.quads, materials));
  RETURN_IF_ERROR(check_list(where + "triangles", shapes.triangles, materials));
  return check_list(where + "disks", shapes.disks, materials);
}

/// Checks that a list of `count` entries is empty or has one entry for each position of its mesh.
absl::Status check_one_per_position(const std::string& field, std::size_t count,
                                    std::size_t positions) {
  if (count != 0 && count != positions) {
    return invalid(field, absl::StrCat("must have one entry for each of the ", positions,
                                       " positions, or none; has ", count));
  }
  return absl::OkStatus();
}

template <std::size_t N>
absl::Status check_finite(const std::string& field,
                          const std::vector<std::array<float, N>>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (const float value : values[i]) {
      if (!std::isfinite(value)) {
        return invalid(item(field, i), absl::StrCat("must be finite, is ", value));
      }
    }
  }
  return absl::OkStatus();
}

absl::Status check_finite_vertices(const std::string& field, const Mesh& mesh) {
  RETURN_IF_ERROR(check_finite(field + ".positions", mesh.positions));
  RETURN_IF_ERROR(check_finite(field + ".normals", mesh.normals));
  RETURN_IF_ERROR(check_finite(field + ".uvs", mesh.uvs));
  RETURN_IF_ERROR(check_finite(field + ".uvs2", mesh.uvs2));
  RETURN_IF_ERROR(check_finite(field + ".positions_at_close", mesh.positions_at_close));
  RETURN_IF_ERROR(check_finite(field + ".normals_at_close", mesh.normals_at_close));
  return check_finite(field + ".colors", mesh.colors);
}

absl::Status check_mesh(const std::string& field, const Mesh& mesh, MeshVertices allowed) {
  if (allowed == MeshVertices::kFinite) {
    RETURN_IF_ERROR(check_finite_vertices(field, mesh));
  }
  const std::size_t vertices = mesh.positions.size();
  RETURN_IF_ERROR(check_one_per_position(field + ".normals", mesh.normals.size(), vertices));
  RETURN_IF_ERROR(check_one_per_position(field + ".uvs", mesh.uvs.size(), vertices));
  RETURN_IF_ERROR(check_one_per_position(field + ".uvs2", mesh.uvs2.size(), vertices));
  RETURN_IF_ERROR(check_one_per_position(field + ".colors", mesh.colors.size(), vertices));
  RETURN_IF_ERROR(check_one_per_position(field + ".positions_at_close",
                                         mesh.positions_at_close.size(), vertices));
  RETURN_IF_ERROR(
      check_one_per_position(field + ".normals_at_close", mesh.normals_at_close.size(), vertices));
  if (!mesh.normals_at_close.empty() && (mesh.normals.empty() || mesh.positions_at_close.empty())) {
    return invalid(field + ".normals_at_close",
                   "must be empty unless the mesh has normals and positions_at_close");
  }
  for (std::size_t i = 0; i < mesh.colors.size(); ++i) {
    for (const float channel : mesh.colors[i]) {
      if (channel < 0) {
        return invalid(item(field + ".colors", i),
                       absl::StrCat("must be >= 0, one channel is ", channel));
      }
    }
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
        return invalid(
            field, absl::StrCat("entries must be within +-", kMaxCoordinate, ", one is ", entry));
      }
    }
  }
  if (!inverse(placement)) {
    return invalid(field,
                   "must have an inverse (it scales by 0, or by factors that differ too much)");
  }
  return absl::OkStatus();
}

absl::Status check_instance(const std::string& field, const Instance& instance,
                            const Geometry& geometry, std::size_t materials) {
  if (instance.group == kNoGroup) {
    RETURN_IF_ERROR(check_index(field + ".mesh", instance.mesh, geometry.meshes.size()));
  } else {
    RETURN_IF_ERROR(check_index(field + ".group", instance.group, geometry.groups.size()));
  }
  if (instance.group == kNoGroup || instance.material != kOwnMaterial) {
    RETURN_IF_ERROR(check_index(field + ".material", instance.material, materials));
  }
  if (instance.frame != kNoFrame) {
    RETURN_IF_ERROR(check_index(field + ".frame", instance.frame, geometry.frames.size()));
  }
  return check_placement(field + ".to_world", instance.to_world);
}

/// Checks a frame. `number` is its index; its parent must have a lower index.
absl::Status check_frame(const std::string& field, const Frame& frame, std::size_t number) {
  if (frame.parent != kNoFrame) {
    RETURN_IF_ERROR(check_index(field + ".parent", frame.parent, number));
  }
  RETURN_IF_ERROR(check_placement(field + ".placement", frame.placement));
  if (frame.keys.empty()) {
    return invalid(field + ".keys", "must have at least one key");
  }
  for (std::size_t i = 0; i < frame.keys.size(); ++i) {
    const Key& key = frame.keys[i];
    const std::string name = absl::StrCat(field, ".keys[", i, "]");
    if (!(std::abs(key.time) <= kMaxTime) || (i > 0 && !(key.time > frame.keys[i - 1].time))) {
      return invalid(name + ".time",
                     absl::StrCat("must be within +-1e9 and after the key before, is ", key.time));
    }
    RETURN_IF_ERROR(check_placement(name + ".at", key.at));
    if (!decompose(key.at)) {
      return invalid(name + ".at",
                     "must be a scale, then a rotation, then a translation; this one shears");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status check_geometry(const std::string& prefix, const Geometry& geometry,
                            std::size_t materials, MeshVertices vertices,
                            const IsChecked& checked) {
  RETURN_IF_ERROR(check_geometry_counts(prefix, geometry));
  RETURN_IF_ERROR(check_shapes(prefix, geometry, materials));
  for (std::size_t i = 0; i < geometry.groups.size(); ++i) {
    RETURN_IF_ERROR(check_shapes(item(prefix + "groups", i) + ".", geometry.groups[i], materials));
  }
  for (std::size_t i = 0; i < geometry.meshes.size(); ++i) {
    if (!checked || !checked(geometry.meshes[i])) {
      RETURN_IF_ERROR(check_mesh(item(prefix + "meshes", i), geometry.meshes[i], vertices));
    }
  }
  for (std::size_t i = 0; i < geometry.frames.size(); ++i) {
    RETURN_IF_ERROR(check_frame(item(prefix + "frames", i), geometry.frames[i], i));
  }
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    RETURN_IF_ERROR(
        check_instance(item(prefix + "instances", i), geometry.instances[i], geometry, materials));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
