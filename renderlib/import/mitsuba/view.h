#pragma once

// Sensors, films and integrators of Mitsuba scenes.

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/mitsuba/conversion.h"

namespace bandsaw::mitsuba {

/// Sets camera and image.
absl::Status set_sensor(const Object& sensor, scene::Scene& scene, Conversion& to);
/// Sets kind and depth.
absl::Status set_integrator(const Object& integrator, scene::Scene& scene, Conversion& to);

}  // namespace bandsaw::mitsuba
