#pragma once

// Which direction to ask an environment for light, and with which density.
//
// The density is the environment's luminance, interpolated as it is seen, minus its mean over all
// directions, where that is above zero: what is even is left to directions from scattering (MIS
// compensation: Karlik et al. 2019, "MIS Compensation: Optimizing Sampling Techniques in Multiple
// Importance Sampling"). So where it is asked at all, luminance above the mean and density are
// proportional to rounding, texel by texel and within each.

#include <cstdint>

#include "absl/types/span.h"
#include "renderlib/light/environment.h"
#include "renderlib/sampling/grid_distribution.h"

namespace bandsaw {

class EnvironmentLight {
 public:
  struct Sample {
    Vec3 direction;  ///< unit, world space
    double pdf = 0;  ///< by solid angle; > 0, finite
  };

  /// Of an environment that is the same from everywhere, or none: never asked.
  EnvironmentLight() = default;
  /// `textures` MUST outlive this and not change.
  EnvironmentLight(Environment environment, absl::Span<const Texture> textures);

  bool empty() const { return !(excess_ > 0); }
  /// Luminance above the mean times solid angle: the irradiance of a surface that faces all of it.
  double excess() const { return excess_; }

  /// u, v in [0, 1); not empty. A sample may be lost to rounding at the rim of what is asked: pdf
  /// 0.
  Sample sample(double u, double v) const;
  /// The density with which sample() makes this unit direction.
  double pdf(const Vec3& unit_direction) const;

 private:
  double weight(const ImageTexture& image, std::uint32_t x, std::uint32_t y) const;
  /// Weight by solid angle at a place whose direction is known.
  double weight_at(const EnvironmentPlace& place) const;

  Environment environment_;
  absl::Span<const Texture> textures_;
  double mean_ = 0;  ///< luminance
  double excess_ = 0;
  GridDistribution texels_;  ///< the images below each other
};

}  // namespace bandsaw
