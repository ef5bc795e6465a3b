#pragma once

// Checks that a scene does not have more lights than can be numbered (light/lights.h). Validation
// of scenes calls it.

#include <cstdint>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/material/material.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Maximum number of lights, which are numbered in 31 bits. The primitives of instances that emit
/// light are numbered too, including those of their primitives that emit none themselves.
inline constexpr std::uint64_t kMaxLights = (std::uint64_t{1} << 31) - 1;

/// Returns INVALID_ARGUMENT if there are more than kMaxLights of these together: loose shapes,
/// primitives of instances that emit light, and the number `delta_lights`. Indices of meshes,
/// groups, materials and textures MUST be valid.
absl::Status check_light_counts(const Geometry& geometry, absl::Span<const Material> materials,
                                absl::Span<const Texture> textures, std::uint64_t delta_lights);

}  // namespace bandsaw
