#pragma once

// The sRGB transfer function (IEC 61966-2-1), between 8-bit codes and linear values.

#include <array>
#include <cstdint>

namespace bandsaw {

/// The transfer function of a linear value in [0, 1]; the inverse of srgb_decode.
double srgb_curve(double linear);

/// The linear value of each code.
const std::array<float, 256>& srgb_table();

/// The linear value of v in [0, 1].
double srgb_decode(double v);

/// The code of a linear value: round(255 f(x)). Below 0 and NaN: 0; above 1: 255. Gives back every
/// code of srgb_table().
std::uint8_t srgb_encode(float linear);

}  // namespace bandsaw
