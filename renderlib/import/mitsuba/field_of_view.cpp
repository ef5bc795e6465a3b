// Converts the field of view of a Mitsuba sensor or projector to half the height of the image plane
// at distance 1. A scene gives the field of view as an angle along a named axis of the image, or as
// a focal length.

#include "renderlib/import/mitsuba/field_of_view.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/read_values.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw::mitsuba {
namespace {

/// Returns half the height of an image plane whose half extent along `axis` is `half`. `aspect` is
/// width / height. Returns INVALID_ARGUMENT for an unknown axis.
absl::StatusOr<double> along_axis(const Parameters& from, double half, const std::string& axis,
                                  double aspect) {
  if (axis == "y" || (axis == "smaller" && aspect > 1) || (axis == "larger" && aspect <= 1)) {
    return half;
  }
  if (axis == "x" || axis == "smaller" || axis == "larger") {
    return half / aspect;
  }
  if (axis == "diagonal") {
    return half / std::sqrt(1 + aspect * aspect);
  }
  return error_at(from.place(), absl::StrCat("fov_axis must be x, y, diagonal, smaller or larger, "
                                             "is \"",
                                             axis, "\""));
}

}  // namespace

absl::StatusOr<double> half_height_of_view(const Parameters& from, double aspect) {
  if (from.has("fov")) {
    ASSIGN_OR_RETURN(const double fov, from.number("fov", 0));
    ASSIGN_OR_RETURN(const std::string axis, from.text("fov_axis", "x"));
    if (!(fov > 0 && fov < 180)) {
      return error_at(from.place(), absl::StrCat("fov must be in (0, 180) degrees, is ", fov));
    }
    return along_axis(from, tan_degrees(fov / 2), axis, aspect);
  }
  from.ignore({"fov_axis"});
  ASSIGN_OR_RETURN(const std::string text, from.text("focal_length", "50mm"));
  const auto millimetres = read_number(absl::StripSuffix(text, "mm"));
  if (!millimetres.ok() || !(*millimetres > 0)) {
    return error_at(
        from.place(),
        absl::StrCat("focal_length must be a length such as \"50mm\", is \"", text, "\""));
  }
  // The focal length is meant for 35 mm film, whose frame has 36 mm x 24 mm.
  return along_axis(from, std::sqrt(36.0 * 36 + 24 * 24) / 2 / *millimetres, "diagonal", aspect);
}

double vertical_fov(double half_height) { return 2 * atan2(half_height, 1) * 180 / kPi; }

}  // namespace bandsaw::mitsuba
