#pragma once

// Converts the emitters of a Mitsuba scene that have no surface: lights and environments.

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/mitsuba/conversion.h"

namespace bandsaw::mitsuba {

/// Adds `emitter` to `scene` as a light or as the background. An emitter of unknown type is left
/// out with a warning. Returns INVALID_ARGUMENT, with file and line, for a parameter that is wrong.
absl::Status add_emitter(const Object& emitter, scene::Scene& scene, Conversion& to);

}  // namespace bandsaw::mitsuba
