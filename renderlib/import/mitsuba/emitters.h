#pragma once

// Converts lights and environments of Mitsuba scenes, which are the emitters without a surface.

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/mitsuba/conversion.h"

namespace bandsaw::mitsuba {

/// Adds a light to `scene` or sets its background. An emitter of unknown type is left out with a
/// warning. Returns INVALID_ARGUMENT, with file and line, for a parameter that is wrong.
absl::Status add_emitter(const Object& emitter, scene::Scene& scene, Conversion& to);

}  // namespace bandsaw::mitsuba
