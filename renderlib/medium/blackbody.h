#pragma once

// Colour of a black body's light, for media with a grid of temperatures (fire).

#include <vector>

#include "renderlib/math/rgb.h"

namespace bandsaw {

/// How the light of black bodies of different temperatures is scaled.
enum class BlackbodyScale {
  kPower,  ///< the luminance is (T / 1000 K)^4 / 1000, with T^4 as in the law of Stefan and
           ///< Boltzmann
  kPeak,   ///< the spectrum's maximum is 1, as in pbrt-v4; the brightness hardly depends on T
};

/// Below this temperature a black body counts as black.
inline constexpr double kDarkKelvin = 100;

/// Returns linear sRGB of a black body at `kelvin` (>= 0, finite): Planck's spectrum, weighted by
/// the colour matching functions of CIE 1931. In colours outside of the gamut (below 1900 K) the
/// negative channel becomes 0, and the luminance is kept. Below 100 K the result is black. Below
/// 500 K the hue is that of 500 K, which is pure red. Above 100,000 K the hue is that of 100,000 K.
Rgb blackbody(double kelvin, BlackbodyScale scale);

/// A table of blackbody(). It has 256 temperatures between each power of 2 and the next, and is
/// interpolated between the temperatures. The relative error is at most 0.2 % from 1000 K to
/// 100,000 K.
class BlackbodyTable {
 public:
  explicit BlackbodyTable(BlackbodyScale scale);
  /// Returns the colour at `kelvin` >= 0. It is black below 100 K. Above 131,072 K it is the colour
  /// at 131,072 K.
  Rgb at(double kelvin) const;

 private:
  std::vector<Rgb> colors_;
};

}  // namespace bandsaw
