#pragma once

// Reads the field of view of Mitsuba's sensors and projectors.

#include "absl/status/statusor.h"
#include "renderlib/import/mitsuba/parameters.h"

namespace bandsaw::mitsuba {

/// Returns half the height of the image plane at distance 1, from the parameters fov, fov_axis and
/// focal_length of a sensor or a projector. `aspect` is width / height. Returns INVALID_ARGUMENT,
/// with file and line, for a value that is not valid.
absl::StatusOr<double> half_height_of_view(const Parameters& from, double aspect);
/// Returns the vertical field of view in degrees. `half_height` is half the height of the image
/// plane at distance 1.
double vertical_fov(double half_height);

}  // namespace bandsaw::mitsuba
