#pragma once

#include "absl/status/statusor.h"
#include "renderlib/import/mitsuba/parameters.h"

namespace bandsaw::mitsuba {

/// Returns half the height of the image plane at distance 1, from fov, fov_axis and focal_length.
/// `aspect` is width / height.
absl::StatusOr<double> half_height_of_view(const Parameters& from, double aspect);
/// Returns the vertical field of view in degrees.
double vertical_fov(double half_height);

}  // namespace bandsaw::mitsuba
