#pragma once

// Tent-shaped interpolation kernel of a texel. The kernel is 1 at the texel's centre and falls
// linearly to 0 at the centres of the neighbouring texels. A linearly interpolated image is sampled
// exactly by first sampling a texel by its weight, and then a point from the tent of this texel
// (light/environment_light.h).

#include <cstdint>

namespace bandsaw {

/// Boundary mode of an image axis: wrapped around, or clamped to the last texel.
enum class Ends : std::uint8_t { kWrapped, kClamped };

/// Samples a coordinate in [0, texels], in texels, with the pdf of the tent of texel `index`; u in
/// [0, 1).
double sample_tent(std::uint32_t index, std::uint32_t texels, Ends ends, double u);

/// Returns the integral of tent * sin(theta) over a full turn, for the tent of row `row` of a
/// latitude-longitude image with `rows` rows. theta in [0, pi] is measured from the top of the
/// image.
double latitude_tent_solid_angle(std::uint32_t row, std::uint32_t rows);
/// Samples theta, in radians, for the tent of row `row`, with a pdf proportional to
/// tent * sin(theta); v in [0, 1).
double sample_latitude_tent(std::uint32_t row, std::uint32_t rows, double v);

}  // namespace bandsaw
