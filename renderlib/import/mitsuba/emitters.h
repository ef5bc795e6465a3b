#pragma once

// Emitters of Mitsuba scenes that are not surfaces.

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/mitsuba/conversion.h"

namespace bandsaw::mitsuba {

/// Adds a light or sets the background.
absl::Status add_emitter(const Object& emitter, scene::Scene& scene, Conversion& to);

}  // namespace bandsaw::mitsuba
