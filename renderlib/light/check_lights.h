#pragma once

// Whether an environment and lights without size can be rendered.

#include <vector>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/light/background.h"
#include "renderlib/light/delta_light.h"

namespace bandsaw {

/// `textures` are valid. INVALID_ARGUMENT: "light[3]: spot.intensity: must be finite and >= 0, is
/// [...]".
absl::Status check_lights(const Background& background, absl::Span<const Texture> textures,
                          const std::vector<DeltaLight>& lights);

}  // namespace bandsaw
