#pragma once

// How the light around a pixel's centre is weighed, by laying out its samples with that density: a
// sample belongs to one pixel and all samples count alike. (Filter importance sampling: Ernst,
// Stamminger and Greiner 2006, "Filter importance sampling", section 3.)

#include "absl/status/status.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

struct PixelFilter {
  enum class Kind {
    kBox,       ///< uniform on the square [-radius, radius]^2
    kTent,      ///< proportional to (radius - |x|) (radius - |y|) on the same square
    kGaussian,  ///< proportional to exp(-r^2 / (2 s^2)), s = radius / 3, on the disk r < radius
  };
  Kind kind = Kind::kBox;
  double radius = 0.5;  ///< pixels, [0, kMaxFilterRadius]
  friend bool operator==(const PixelFilter&, const PixelFilter&) = default;
};

inline constexpr double kMaxFilterRadius = 16;

/// The radius of a filter for which none is given.
double default_radius(PixelFilter::Kind kind);

/// INVALID_ARGUMENT: the radius.
absl::Status validate(const PixelFilter& filter);

/// Where to look, in pixels from the pixel's centre; u, v in [0, 1). Of the default filter exactly
/// (u - 0.5, v - 0.5) for multiples of 2^-32.
Vec2 sample(const PixelFilter& filter, double u, double v);

}  // namespace bandsaw
