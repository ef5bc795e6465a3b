#pragma once

// How light fades on a way through a medium: exp(-sigma s), in closed form (Bouguer 1729, Lambert
// 1760). Lengths are in scene units and may be infinite.

#include "renderlib/math/rgb.h"
#include "renderlib/medium/medium.h"

namespace bandsaw {

/// Absorption and scattering of one channel, in double: sums of floats of any size.
inline double extinction(float absorption, float scattering) {
  return double{absorption} + scattering;
}

/// Over the channels.
double mean_extinction(const Medium& medium);

/// The share of light that passes a length of extinction sigma; exactly 1 where there is none.
double transmittance(double sigma, double length);

/// The integral of exp(-sigma s) over s in [0, length]: the length, as far as light gets.
/// Infinite where sigma is 0 and the length infinite.
double reach(double sigma, double length);

/// The share of light that passes, by channel.
Rgb transmittance(const Medium& medium, double length);

/// The radiance that the medium itself gives along a length of it, without its scattering. MUST
/// NOT be asked of an infinite length where a channel emits and fades nowhere.
Rgb own_radiance(const Medium& medium, double length);

}  // namespace bandsaw
