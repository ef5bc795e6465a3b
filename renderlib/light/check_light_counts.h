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

/// Maximum number of lights: they are numbered in 31 bits. Some primitives that emit nothing get
/// numbers too: if an instance emits light anywhere, all of its primitives are numbered.
inline constexpr std::uint64_t kMaxLights = (std::uint64_t{1} << 31) - 1;

/// Returns INVALID_ARGUMENT if more than kMaxLights numbers are needed: one for each shape that is
/// not in an instance, one for each primitive of each instance that emits light anywhere, and one
/// for each of the `delta_lights` lights without size. Indices of meshes, groups, materials and
/// textures MUST be valid.
absl::Status check_light_counts(const Geometry& geometry, absl::Span<const Material> materials,
                                absl::Span<const Texture> textures, std::uint64_t delta_lights);

}  // namespace bandsaw
