#pragma once

// Checks that a scene does not have more lights than can be numbered (light/lights.h).

#include <cstdint>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/material/material.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Maximum number of lights: they are numbered in 31 bits, and so are the primitives of instances
/// that emit light, including those that emit none themselves.
inline constexpr std::uint64_t kMaxLights = (std::uint64_t{1} << 31) - 1;

/// Returns INVALID_ARGUMENT if the loose shapes, the primitives of all instances that emit light
/// and `delta_lights` together are more than kMaxLights. Indices of meshes, groups, materials and
/// textures MUST be valid.
absl::Status check_light_counts(const Geometry& geometry, absl::Span<const Material> materials,
                                absl::Span<const Texture> textures, std::uint64_t delta_lights);

}  // namespace bandsaw
