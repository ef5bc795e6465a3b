#pragma once

// Checks shared by the validation of all parts of a description. Errors name the field, the allowed
// range and the value.

#include <cmath>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/ids.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"
#include "renderlib/scene/validate.h"

namespace bandsaw {

/// Returns the error "<field>: <why>".
inline absl::Status invalid(absl::string_view field, absl::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat(field, ": ", why));
}

/// Returns the name of an entry: "spheres[3]".
inline std::string item(absl::string_view list, std::size_t index) {
  return absl::StrCat(list, "[", index, "]");
}

template <class Id>
absl::Status check_index(const std::string& field, Id id, std::size_t count) {
  if (index_of(id) >= count) {
    return invalid(field, absl::StrCat("must be below ", count, ", is ", index_of(id)));
  }
  return absl::OkStatus();
}

inline absl::Status check_point(const std::string& field, const Vec3& p) {
  if (!is_finite(p) || max_abs(p) > kMaxCoordinate) {
    return invalid(field, absl::StrCat("must be within +-", kMaxCoordinate, ", is [", p.x, ", ",
                                       p.y, ", ", p.z, "]"));
  }
  return absl::OkStatus();
}

/// Checks that the channels are finite and in [0, most]; `most` may be infinite.
inline absl::Status check_color(const std::string& field, const Rgb& color, float most) {
  for (const float value : {color.r, color.g, color.b}) {
    if (!(value >= 0 && value <= most) || !std::isfinite(value)) {
      const std::string range = std::isfinite(most) ? absl::StrCat("in [0, ", most, "]")
                                                    : std::string("finite and not negative");
      return invalid(field, absl::StrCat("must be ", range, ", is ", value));
    }
  }
  return absl::OkStatus();
}

/// Checks textures and materials (validate_surfaces.cpp).
absl::Status check_surfaces(const SceneDescription& scene);

/// Checks materials (validate_materials.cpp). The textures MUST have been checked before.
absl::Status check_materials(const std::vector<Material>& materials,
                             const std::vector<Texture>& textures);

/// Checks shapes, meshes, groups, frames and instances (validate_geometry.cpp). `prefix` is
/// prepended to the names of fields in errors. `materials` is the number of materials, or the
/// number of media if the shapes are boundaries of media. `vertices` and `checked` are the
/// parameters of validate().
absl::Status check_geometry(const std::string& prefix, const Geometry& geometry,
                            std::size_t materials, MeshVertices vertices,
                            const IsChecked& checked = {});

}  // namespace bandsaw
