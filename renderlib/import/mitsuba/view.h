#pragma once

// Converts sensors, films and integrators of Mitsuba scenes.

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/mitsuba/conversion.h"

namespace bandsaw::mitsuba {

/// Sets the camera and the image of `scene`. Returns INVALID_ARGUMENT, with file and line, for an
/// unknown type of sensor and for a value that is not valid.
absl::Status set_sensor(const Object& sensor, scene::Scene& scene, Conversion& to);
/// Sets the kind and the maximum path depth of the scene's integrator, and
/// Conversion::passages_are_free.
absl::Status set_integrator(const Object& integrator, scene::Scene& scene, Conversion& to);

}  // namespace bandsaw::mitsuba
