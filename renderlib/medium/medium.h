#pragma once

// Homogeneous participating media: smoke, fog, milk.

#include "renderlib/math/rgb.h"

namespace bandsaw {

/// Coefficients per scene unit and channel, >= 0. With absorption and scattering 0 the medium is
/// empty space.
struct Medium {
  Rgb absorption = {};  ///< absorption coefficient
  Rgb scattering = {};  ///< scattering coefficient
  Rgb emission = {};    ///< emitted radiance per length
  double g = 0;         ///< mean cosine of the phase function (medium/phase.h), in [-kMaxG, kMaxG]
  friend bool operator==(const Medium&, const Medium&) = default;
};

/// Maximum of |g|; closer to 1, scattering would degenerate to a beam.
inline constexpr double kMaxG = 0.999;
/// Maximum coefficient: at this value 1e-12 scene units are already opaque.
inline constexpr float kMaxPerUnit = 1e12f;

/// Returns true if a channel emits and has no extinction: an infinite medium would be infinitely
/// bright.
constexpr bool is_endless_glow(const Medium& m) {
  const auto endless = [](float emission, float absorption, float scattering) {
    return emission > 0 && absorption == 0 && scattering == 0;
  };
  return endless(m.emission.r, m.absorption.r, m.scattering.r) ||
         endless(m.emission.g, m.absorption.g, m.scattering.g) ||
         endless(m.emission.b, m.absorption.b, m.scattering.b);
}

/// Returns true if the medium has no effect on light.
constexpr bool is_clear(const Medium& medium) {
  return is_black(medium.absorption) && is_black(medium.scattering) && is_black(medium.emission);
}

}  // namespace bandsaw
