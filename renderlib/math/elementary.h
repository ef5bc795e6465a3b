#pragma once

// Elementary functions with the same bits on every CPU and libm: built from + - * / sqrt and
// std::fma alone. (glibc selects among variants of its double functions by CPU; they differ in the
// last bits.) Double, error at most 2 units in the last place of the result over the stated domain.
// Nothing in renderlib calls the <cmath> function of the same name.

namespace bandsaw {

struct SinCos {
  double sin;
  double cos;
};

/// sin and cos of 2 pi u, exact at multiples of 1/4; any finite u.
SinCos sincos_turns(double u);
/// sin and cos of an angle in degrees, exact at multiples of 90.
SinCos sincos_degrees(double degrees);
/// tan of an angle in degrees, in (-90, 90).
double tan_degrees(double degrees);

/// In (-pi, pi]; 0 at (0, 0).
double atan2(double y, double x);
/// x is clamped to [-1, 1]; in [-pi/2, pi/2].
double asin(double x);
/// x is clamped to [-1, 1]; in [0, pi].
double acos(double x);

/// Overflows to infinity, underflows to 0.
double exp(double x);
/// exp(x) - 1 without cancellation near 0.
double expm1(double x);
/// x > 0.
double log(double x);
/// log(1 + x) without cancellation near 0; x > -1.
double log1p(double x);
/// x >= 0; exp(y log x) with enough digits for colours: relative error at most 1e-14 for results in
/// [1e-30, 1e30].
double pow(double x, double y);

}  // namespace bandsaw
