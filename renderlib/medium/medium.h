#pragma once

// Participating media, such as smoke, fog, milk and fire. A medium is homogeneous, or it varies in
// space as given by grids.

#include <cstdint>
#include <optional>

#include "renderlib/base/ids.h"
#include "renderlib/math/rgb.h"
#include "renderlib/medium/blackbody.h"

namespace bandsaw {

enum class GridId : std::uint32_t {};

/// A grid of the scene (medium/volume_grid.h) whose numbers are multiplied by `scale` (>= 0,
/// finite).
struct GridUse {
  GridId grid{};
  float scale = 1;
  friend bool operator==(const GridUse&, const GridUse&) = default;
};

/// Grids by which a medium varies in space. Outside of its box, a grid has the value 0. The values
/// of the grids at a point determine the properties of the medium at this point. In the equations,
/// absorption, scattering and emission on the right are the members of struct Medium:
///
///   density     = value of the density grid, by channel if it has three; 1 without this grid
///   extinction  = density (absorption + scattering)
///   scattering  = density scattering; with an albedo grid, extinction times min(its value, 1)
///   emission    = emission times f times t
///                 f: the value of the emission grid; without an emission grid, the density
///                 t: blackbody(value of the temperature grid + temperature_offset); without a
///                 temperature grid, 1
struct MediumGrids {
  std::optional<GridUse> density;
  std::optional<GridUse> albedo;
  std::optional<GridUse> emission;
  std::optional<GridUse> temperature;  ///< kelvin
  double temperature_offset = 0;       ///< kelvin, finite
  BlackbodyScale blackbody = BlackbodyScale::kPower;

  bool any() const { return density || albedo || emission || temperature; }
  friend bool operator==(const MediumGrids&, const MediumGrids&) = default;
};

/// Coefficients per scene unit and channel, >= 0. If absorption, scattering and emission are 0, the
/// medium is empty space. With grids, the members are the coefficients where the density is 1.
struct Medium {
  Rgb absorption = {};  ///< absorption coefficient
  Rgb scattering = {};  ///< scattering coefficient
  Rgb emission = {};    ///< emitted radiance per length
  double g = 0;         ///< mean cosine of the phase function (medium/phase.h), in [-kMaxG, kMaxG]
  MediumGrids grids = {};
  friend bool operator==(const Medium&, const Medium&) = default;
};

/// Maximum of |g|; closer to 1, scattering would degenerate to a beam.
inline constexpr double kMaxG = 0.999;
/// Maximum coefficient: at this value, 1e-12 scene units have an optical depth of 1.
inline constexpr float kMaxPerUnit = 1e12f;

/// Returns true if a channel emits and has no extinction. Without an end, such a medium would be
/// infinitely bright.
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
