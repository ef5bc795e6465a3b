#pragma once

// Whether a texture that is made of others or computed can be evaluated.

#include <string>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Most textures that one look-up may evaluate.
inline constexpr std::uint64_t kMaxTextureParts = 256;
inline constexpr std::size_t kMaxRampStops = 256;
inline constexpr std::uint32_t kMaxOctaves = 16;

/// textures[index]: parts stand before it, numbers are in their ranges; says nothing of constants
/// and of texels. `cost` is how many textures each one before it evaluates; its own is appended.
/// INVALID_ARGUMENT: "checker.even: must be below 3, is 4".
absl::Status check_parts(absl::Span<const Texture> textures, std::size_t index,
                         std::vector<std::uint64_t>& cost);

}  // namespace bandsaw
