// Samples an offset from a pixel's centre with the density of the filter, which is a box, a tent or
// a truncated Gaussian.

#include "renderlib/camera/pixel_filter.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Returns the inverse of the cumulative distribution of the density 1 - |x| on [-1, 1], at `u`.
double tent(double u) { return u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u)); }

/// Samples a normal distribution of standard deviation 1, truncated at the radius 3 (Box and Muller
/// 1958, with the radial distribution rescaled to end at this radius).
Vec2 gaussian(double u, double v) {
  constexpr double kCut = 3;
  const double r = std::sqrt(-2 * log1p(u * expm1(-kCut * kCut / 2)));
  const SinCos angle = sincos_turns(v);
  return {r * angle.cos, r * angle.sin};
}

}  // namespace

double default_radius(PixelFilter::Kind kind) {
  switch (kind) {
    case PixelFilter::Kind::kBox:
      return 0.5;
    case PixelFilter::Kind::kTent:
      return 1;
    case PixelFilter::Kind::kGaussian:
      return 1.5;
  }
  return 0.5;
}

absl::Status validate(const PixelFilter& filter) {
  if (filter.radius >= 0 && filter.radius <= kMaxFilterRadius) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat("filter.radius: must be in [0, ", kMaxFilterRadius,
                                                 "] pixels, is ", filter.radius));
}

Vec2 sample(const PixelFilter& filter, double u, double v) {
  switch (filter.kind) {
    case PixelFilter::Kind::kBox:
      break;
    case PixelFilter::Kind::kTent:
      return Vec2{tent(u), tent(v)} * filter.radius;
    case PixelFilter::Kind::kGaussian:
      return gaussian(u, v) * (filter.radius / 3);
  }
  return Vec2{2 * u - 1, 2 * v - 1} * filter.radius;
}

}  // namespace bandsaw
