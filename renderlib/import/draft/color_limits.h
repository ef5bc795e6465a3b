#pragma once

// The largest values that a channel of a reflectance, a channel of a radiance and a height in a
// texture may have, in scenes of all formats. Products of a few radiances or heights above these
// values would overflow.

namespace bandsaw {

inline constexpr float kMaxReflectance = 1;
inline constexpr float kMaxRadiance = 1e30f;
inline constexpr float kMaxHeight = 1e30f;

}  // namespace bandsaw
