#pragma once

// Attenuation in a homogeneous medium: transmittance exp(-sigma s) in closed form (Bouguer 1729,
// Lambert 1760). Lengths are in scene units and may be infinite.

#include "renderlib/math/rgb.h"
#include "renderlib/medium/medium.h"

namespace bandsaw {

/// Returns the extinction coefficient of one channel. It is a double, because the sum of two large
/// floats may overflow.
inline double extinction(float absorption, float scattering) {
  return double{absorption} + scattering;
}

/// Returns the mean extinction coefficient over the channels.
double mean_extinction(const Medium& medium);

/// Returns the transmittance exp(-sigma length), where sigma (>= 0) is an extinction coefficient;
/// exactly 1 if sigma is 0, for any length.
double transmittance(double sigma, double length);

/// Returns the integral of exp(-sigma s) over s in [0, length], i.e. an effective length. It is
/// infinite if sigma is 0 and the length is infinite.
double reach(double sigma, double length);

/// Returns the transmittance over `length` by channel.
Rgb transmittance(const Medium& medium, double length);

/// Returns the radiance that the medium emits along `length`, attenuated by the medium, without
/// scattering. If a channel emits and has no extinction, the length MUST be finite.
Rgb own_radiance(const Medium& medium, double length);

}  // namespace bandsaw
