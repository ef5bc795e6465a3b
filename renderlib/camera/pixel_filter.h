#pragma once

// Pixel reconstruction filters, applied by importance sampling: samples are placed with the
// filter's density, so each belongs to one pixel and all have equal weight (Ernst, Stamminger and
// Greiner 2006, "Filter importance sampling", section 3).

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

inline constexpr double kMaxFilterRadius = 16;  ///< pixels

/// Returns the radius that is used if none is given.
double default_radius(PixelFilter::Kind kind);

/// Returns INVALID_ARGUMENT if the radius is out of range.
absl::Status validate(const PixelFilter& filter);

/// Returns the sample's offset from the pixel's centre, in pixels; u, v in [0, 1). For the default
/// filter the offset is exactly (u - 0.5, v - 0.5) if u and v are multiples of 2^-32.
Vec2 sample(const PixelFilter& filter, double u, double v);

}  // namespace bandsaw
