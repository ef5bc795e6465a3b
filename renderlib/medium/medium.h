#pragma once

// What fills a part of space: smoke, fog, milk. The same everywhere in it.

#include "renderlib/math/rgb.h"

namespace bandsaw {

/// Everything is per scene unit and channel, >= 0. An absorption and scattering of 0 is empty
/// space.
struct Medium {
  Rgb absorption = {};  ///< share of the light that is lost on a short way, over its length
  Rgb scattering = {};  ///< share of the light that is sent elsewhere, over the length
  Rgb emission = {};    ///< radiance that is added on a short way, over its length
  double g = 0;         ///< mean cosine of scattering (medium/phase.h), in [-kMostG, kMostG]
  friend bool operator==(const Medium&, const Medium&) = default;
};

/// |g| nearer to 1 would make a beam of what is no longer scattering.
inline constexpr double kMostG = 0.999;
/// Coefficients beyond this are refused: a millionth of a millionth of a scene unit is opaque.
inline constexpr float kMostPerUnit = 1e12f;

/// Whether a channel gives light and fades nowhere: a medium without end would be infinitely
/// bright.
constexpr bool is_endless_glow(const Medium& m) {
  const auto endless = [](float emission, float absorption, float scattering) {
    return emission > 0 && absorption == 0 && scattering == 0;
  };
  return endless(m.emission.r, m.absorption.r, m.scattering.r) ||
         endless(m.emission.g, m.absorption.g, m.scattering.g) ||
         endless(m.emission.b, m.absorption.b, m.scattering.b);
}

/// Whether light passes as through nothing.
constexpr bool is_clear(const Medium& medium) {
  return is_black(medium.absorption) && is_black(medium.scattering) && is_black(medium.emission);
}

}  // namespace bandsaw
