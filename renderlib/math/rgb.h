#pragma once

// Colours and radiance: linear, sRGB primaries, float. Sums over samples are double
// (render/film.h).

#include <algorithm>
#include <cmath>

namespace bandsaw {

struct Rgb {
  float r = 0;
  float g = 0;
  float b = 0;
  friend constexpr bool operator==(const Rgb&, const Rgb&) = default;
};

constexpr Rgb gray(float v) { return {v, v, v}; }
constexpr Rgb operator+(const Rgb& a, const Rgb& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
constexpr Rgb operator*(const Rgb& a, const Rgb& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
constexpr Rgb operator*(const Rgb& a, float s) { return {a.r * s, a.g * s, a.b * s}; }
constexpr Rgb operator*(float s, const Rgb& a) { return a * s; }
constexpr Rgb& operator+=(Rgb& a, const Rgb& b) { return a = a + b; }
constexpr Rgb& operator*=(Rgb& a, const Rgb& b) { return a = a * b; }
constexpr Rgb lerp(const Rgb& a, const Rgb& b, float t) { return a * (1 - t) + b * t; }
constexpr float max_component(const Rgb& a) { return std::max({a.r, a.g, a.b}); }
constexpr bool is_black(const Rgb& a) { return a.r == 0 && a.g == 0 && a.b == 0; }
/// Returns the Rec. 709 luminance.
constexpr float luminance(const Rgb& a) { return 0.2126f * a.r + 0.7152f * a.g + 0.0722f * a.b; }
/// Returns the Rec. 709 luminance, without rounding errors for greys: if r, g and b are equal, the
/// result is exactly r. So the result can be compared with a limit, while luminance() may return a
/// slightly smaller number.
constexpr float luminance_exact_for_grays(const Rgb& a) {
  return a.g + 0.2126f * (a.r - a.g) + 0.0722f * (a.b - a.g);
}
inline bool is_finite(const Rgb& a) {
  return std::isfinite(a.r) && std::isfinite(a.g) && std::isfinite(a.b);
}

}  // namespace bandsaw
