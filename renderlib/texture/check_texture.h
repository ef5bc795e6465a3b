#pragma once

// Validation of composite and procedural textures, a part of the validation of scenes.

#include <string>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Maximum number of textures that one lookup may evaluate.
inline constexpr std::uint64_t kMaxTextureParts = 256;
/// Maximum width and height of an image, in texels.
inline constexpr std::uint32_t kMaxTextureSide = 65536;
inline constexpr std::size_t kMaxRampStops = 256;
inline constexpr std::uint32_t kMaxOctaves = 16;

/// Checks that the textures to which textures[index] refers precede it, that its numbers are in
/// their ranges, and that one lookup evaluates at most kMaxTextureParts textures. Constants and
/// texels are not checked. `cost` holds the number of textures that a lookup of each preceding
/// texture evaluates; that of textures[index] is appended. Otherwise returns INVALID_ARGUMENT, e.g.
/// "checker.even: must be below 3, is 4".
absl::Status check_parts(absl::Span<const Texture> textures, std::size_t index,
                         std::vector<std::uint64_t>& cost);

}  // namespace bandsaw
