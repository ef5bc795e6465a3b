#pragma once

// Validation of environment maps and delta lights (lights without size), a part of the validation
// of scenes.

#include <vector>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/light/background.h"
#include "renderlib/light/delta_light.h"

namespace bandsaw {

/// Checks the background's environment and the delta lights. `textures` MUST be valid. Returns
/// INVALID_ARGUMENT with a message that names field, bound and value: "light[3]: spot.intensity:
/// must be finite and >= 0, is [...]".
absl::Status check_lights(const Background& background, absl::Span<const Texture> textures,
                          const std::vector<DeltaLight>& lights);

}  // namespace bandsaw
