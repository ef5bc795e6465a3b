#pragma once

// Colour spaces in which differences are closer to what an eye sees. All of one pixel; white is
// that of sRGB (D65).

#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Brought into [0, 1]; NaN becomes 0.
Rgb clamped(const Rgb& linear);

/// CIE XYZ over that of white, and back.
Vec3 xyz_over_white(const Rgb& linear);
Vec3 linear_of(const Vec3& xyz_over_white);

/// YyCxCz: linear opponents (Flohr et al. 1993) of XYZ over white.
Vec3 opponents(const Vec3& xyz_over_white);
Vec3 xyz_of_opponents(const Vec3& opponents);

/// CIE L*a*b*.
Vec3 lab(const Vec3& xyz_over_white);

}  // namespace bandsaw
