// Reads vectors, colours and numbers of a scene file and checks their ranges; errors name the
// field.

#include "renderlib/import/scene_file/numbers.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"

namespace bandsaw {
namespace {

constexpr double kMaxCoordinate = 1e30;

/// Returns INVALID_ARGUMENT for the field `name` unless the list has three numbers.
absl::Status check_three(const Field& in, const std::string& name, const Numbers& list) {
  if (list.empty()) {
    return in.error(name, "is required: a list of three numbers");
  }
  if (list.size() != 3) {
    return in.error(name, absl::StrCat("must be a list of 3 numbers, has ", list.size()));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Vec3> read_vec3(const Field& in, const std::string& name, const Numbers& list) {
  RETURN_IF_ERROR(check_three(in, name, list));
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(list[i]) <= kMaxCoordinate)) {
      return in.error(name, absl::StrCat("must be finite, at most 1e30, is ", list[i]), i);
    }
  }
  return Vec3{list[0], list[1], list[2]};
}

absl::StatusOr<Vec3> read_vec3(const Field& in, const std::string& name, const Numbers& list,
                               const Vec3& otherwise) {
  if (list.empty()) {
    return otherwise;
  }
  return read_vec3(in, name, list);
}

absl::StatusOr<Vec3> read_direction(const Field& in, const std::string& name, const Numbers& list) {
  ASSIGN_OR_RETURN(const Vec3 v, read_vec3(in, name, list));
  if (!(length_squared(v) > 0)) {
    return in.error(name, "must not be zero");
  }
  return v;
}

absl::Status check_range(const Field& in, const std::string& name, double value, double least,
                         double most) {
  if (value >= least && value <= most) {
    return absl::OkStatus();
  }
  return in.error(name, absl::StrCat("must lie in [", least, ", ", most, "], is ", value));
}

absl::StatusOr<Rgb> read_color(const Field& in, const scene::Color& color, float most) {
  RETURN_IF_ERROR(check_three(in, "rgb", color.rgb()));
  for (int i = 0; i < 3; ++i) {
    const double value = color.rgb(i);
    if (!(value >= 0 && value <= most)) {
      const std::string allowed =
          most == kMaxReflectance ? "must lie in [0, 1]" : "must be finite and >= 0";
      return in.error("rgb", absl::StrCat(allowed, ", is ", value), i);
    }
  }
  return Rgb{static_cast<float>(color.rgb(0)), static_cast<float>(color.rgb(1)),
             static_cast<float>(color.rgb(2))};
}

}  // namespace bandsaw
