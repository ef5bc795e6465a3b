#pragma once

// Conversions of single pixels to perceptual colour spaces, for FLIP and SSIM. The white point is
// that of sRGB (D65); "linear" is linear RGB with the primaries of sRGB.

#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Returns the colour clamped to [0, 1]; NaN becomes 0.
Rgb clamped(const Rgb& linear);

/// Converts to CIE XYZ relative to the white point, and back.
Vec3 xyz_over_white(const Rgb& linear);
Vec3 linear_of(const Vec3& xyz_over_white);

/// Converts XYZ relative to white to YyCxCz, a linear opponent space (Flohr et al. 1993), and back.
Vec3 opponents(const Vec3& xyz_over_white);
Vec3 xyz_of_opponents(const Vec3& opponents);

/// Converts to CIE L*a*b*.
Vec3 lab(const Vec3& xyz_over_white);

}  // namespace bandsaw
