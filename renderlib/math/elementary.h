#pragma once

// Elementary functions whose results have the same bits on every CPU and with every C library. They
// are built only from + - * / sqrt and fma. (glibc selects a variant of its double functions by
// CPU, and the variants differ in the last bits.) Except for pow(), their error is at most 2 units
// in the last place over the stated domain. renderlib never calls the <cmath> functions of the same
// names.

namespace bandsaw {

struct SinCos {
  double sin;
  double cos;
};

/// Returns sine and cosine of 2 pi u for any finite u. They are exact if u is a multiple of 1/4.
SinCos sincos_turns(double u);
/// Returns sine and cosine of an angle in degrees, exact at multiples of 90.
SinCos sincos_degrees(double degrees);
/// Returns the tangent of an angle in degrees, in (-90, 90).
double tan_degrees(double degrees);

/// Returns the angle of (x, y) in (-pi, pi]; 0 at (0, 0).
double atan2(double y, double x);
/// Returns the arcsine of x, in [-pi/2, pi/2]; x is clamped to [-1, 1].
double asin(double x);
/// Returns the arccosine of x, in [0, pi]; x is clamped to [-1, 1].
double acos(double x);

/// Returns e^x, which overflows to infinity and underflows to 0.
double exp(double x);
/// Returns exp(x) - 1 without cancellation near 0.
double expm1(double x);
/// Returns the natural logarithm; x > 0.
double log(double x);
/// Returns log(1 + x) without cancellation near 0; x > -1.
double log1p(double x);
/// Returns exp(y log x) for x >= 0, precise enough for colours: the relative error is at most 1e-14
/// for results in [1e-30, 1e30].
double pow(double x, double y);

}  // namespace bandsaw
