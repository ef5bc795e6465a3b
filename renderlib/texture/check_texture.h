#pragma once

// Validation of composite and procedural textures.

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

/// Checks textures[index]: the textures it refers to precede it, and numbers are in their ranges.
/// Constants and texels are not checked. `cost` holds the number of textures that each preceding
/// one evaluates; its own is appended. Returns INVALID_ARGUMENT: "checker.even: must be below 3, is
/// 4".
absl::Status check_parts(absl::Span<const Texture> textures, std::size_t index,
                         std::vector<std::uint64_t>& cost);

}  // namespace bandsaw
