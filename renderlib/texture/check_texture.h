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

/// Returns INVALID_ARGUMENT, e.g. "checker.even: must be below 3, the index of this texture; it is
/// 4", in three cases:
/// - textures[index] refers to a texture that does not precede it in the list,
/// - a number of textures[index] is out of range,
/// - one lookup of textures[index] would evaluate more than kMaxTextureParts textures.
/// The values of constants and texels are not checked.
///
/// cost[i] is the number of textures that one lookup of textures[i] evaluates. `cost` MUST have
/// an entry for each i < index. On success the cost of textures[index] is appended.
absl::Status check_parts(absl::Span<const Texture> textures, std::size_t index,
                         std::vector<std::uint64_t>& cost);

}  // namespace bandsaw
