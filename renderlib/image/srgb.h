#pragma once

// The sRGB transfer function (IEC 61966-2-1), between 8-bit codes and linear values.

#include <array>
#include <cstdint>

namespace bandsaw {

/// Returns the sRGB value of a linear value in [0, 1]; the inverse of srgb_decode.
double srgb_curve(double linear);

/// Returns the linear value of each 8-bit code.
const std::array<float, 256>& srgb_table();

/// Returns the linear value of an sRGB value in [0, 1].
double srgb_decode(double v);

/// Returns the 8-bit code of a linear value, round(255 srgb_curve(linear)); 0 for negative values
/// and NaN, 255 above 1. Inverts srgb_table() exactly.
std::uint8_t srgb_encode(float linear);

}  // namespace bandsaw
