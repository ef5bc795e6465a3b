#pragma once

// What a channel of a colour may be at most, wherever it was written: beyond, products of a few of
// them would overflow.

namespace bandsaw {

inline constexpr float kMaxReflectance = 1;
inline constexpr float kMaxRadiance = 1e30f;

}  // namespace bandsaw
