#pragma once

// Whether a scene has no more lights than have numbers (light/lights.h).

#include <cstdint>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/material/material.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Lights are numbered in 31 bits, and so are the primitives of what shines, dark ones among them.
inline constexpr std::uint64_t kMaxLights = (std::uint64_t{1} << 31) - 1;

/// INVALID_ARGUMENT: the loose shapes, the primitives of all instances that shine, and
/// `without_size` lights without size are more than kMaxLights. Nothing is allocated for them.
/// Indices into the geometry, of materials and of textures MUST be valid.
absl::Status check_light_counts(const Geometry& geometry, absl::Span<const Material> materials,
                                absl::Span<const Texture> textures, std::uint64_t without_size);

}  // namespace bandsaw
