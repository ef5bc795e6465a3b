#pragma once

// Importance sampling of an environment map, as one of the lights of a scene (light/lights.h).
//
// The excess of a texel is its luminance minus the mean over all directions, clamped at zero. The
// pdf is proportional to the bilinear interpolation of the excess. Apart from rounding errors, the
// proportion is exact everywhere, also within a texel. The face of a cube map is an exception:
// there each texel has a weight, its excess times its solid angle, and the pdf by area is
// proportional to the bilinear interpolation of the weights. The uniform part of the light is left
// to BSDF sampling (MIS compensation: Karlik et al. 2019, "MIS Compensation: Optimizing Sampling
// Techniques in Multiple Importance Sampling").

#include <cstdint>

#include "absl/types/span.h"
#include "renderlib/light/environment.h"
#include "renderlib/sampling/grid_distribution.h"

namespace bandsaw {

class EnvironmentLight {
 public:
  struct Sample {
    Vec3 direction;  ///< unit, world space
    double pdf = 0;  ///< by solid angle; >= 0, finite
  };

  /// Makes an empty light, like that of a uniform environment. An empty light is never sampled.
  EnvironmentLight() = default;
  /// `textures` MUST outlive this object and not change.
  EnvironmentLight(Environment environment, absl::Span<const Texture> textures);

  bool empty() const { return !(excess_ > 0); }
  /// Returns the integral over all directions of the luminance above the mean.
  double excess() const { return excess_; }

  /// Samples a direction; u, v in [0, 1). The light MUST NOT be empty. At the border of the sampled
  /// region rounding may yield a direction with pdf 0.
  Sample sample(double u, double v) const;
  /// Returns the pdf, by solid angle, with which `sample()` returns this unit direction.
  double pdf(const Vec3& unit_direction) const;

 private:
  /// Returns the luminance of a texel above the mean; 0 if it is below.
  double weight(const ImageTexture& image, std::uint32_t x, std::uint32_t y) const;
  /// Returns the unnormalised pdf, by solid angle, of the direction at a position in the images.
  double weight_at(const EnvironmentPlace& place) const;

  Environment environment_;
  absl::Span<const Texture> textures_;
  double mean_ = 0;  ///< mean luminance over all directions
  double excess_ = 0;
  GridDistribution texels_;  ///< weight() times solid angle; the images are stacked vertically
};

}  // namespace bandsaw
