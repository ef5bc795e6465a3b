#pragma once

// The share that a texel has in a linearly interpolated image: 1 at its centre, falling to 0 at the
// centres of its neighbours. To draw a point with the density of an interpolated image, draw a
// texel by its weight and then a point from its tent.

#include <cstdint>

namespace bandsaw {

/// How an axis of an image ends: it goes on at its other end, or its last texel stays.
enum class Ends : std::uint8_t { kWrapped, kClamped };

/// A coordinate in [0, texels] with the density of the tent of texel `index`, in texels; u in [0,
/// 1).
double sample_tent(std::uint32_t index, std::uint32_t texels, Ends ends, double u);

/// The tent times sin(theta), along a column of an equirectangular image of `rows` rows, theta in
/// [0, pi] from its top row. What a row has in common: its tent's solid angle for a whole turn.
double latitude_tent_solid_angle(std::uint32_t row, std::uint32_t rows);
/// theta with that density; v in [0, 1).
double sample_latitude_tent(std::uint32_t row, std::uint32_t rows, double v);

}  // namespace bandsaw
