// Closed forms of transmittance and emission along a length, exact also for tiny and infinite
// optical depths.

#include "renderlib/medium/attenuation.h"

#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// For larger x, exp(-x) underflows to 0 in double.
constexpr double kOpaque = 800;

/// Returns sigma * length, and 0 if sigma is 0, even for an infinite length.
double optical_length(double sigma, double length) {
  if (sigma == 0) {
    return 0;
  }
  return sigma * length;
}

}  // namespace

double mean_extinction(const Medium& medium) {
  const Rgb sum = medium.absorption + medium.scattering;
  return (double{sum.r} + sum.g + sum.b) / 3;
}

double transmittance(double sigma, double length) {
  const double depth = optical_length(sigma, length);
  if (depth == 0) {
    return 1;
  }
  return depth < kOpaque ? exp(-depth) : 0;
}

/// Returns the integral of the transmittance over a path of this length, for extinction `sigma`.
double reach(double sigma, double length) {
  const double depth = optical_length(sigma, length);
  // For depths below kShort, -expm1(-depth) / sigma equals the length to the last bit or
  // underflows.
  constexpr double kShort = 1e-17;
  if (depth < kShort) {
    return length;
  }
  return depth < kOpaque ? -expm1(-depth) / sigma : 1 / sigma;
}

Rgb transmittance(const Medium& medium, double length) {
  const Rgb& a = medium.absorption;
  const Rgb& s = medium.scattering;
  return {static_cast<float>(transmittance(extinction(a.r, s.r), length)),
          static_cast<float>(transmittance(extinction(a.g, s.g), length)),
          static_cast<float>(transmittance(extinction(a.b, s.b), length))};
}

Rgb own_radiance(const Medium& medium, double length) {
  const Rgb& a = medium.absorption;
  const Rgb& s = medium.scattering;
  const auto channel = [length](float emission, double sigma) {
    return emission == 0 ? 0.0f : static_cast<float>(emission * reach(sigma, length));
  };
  return {channel(medium.emission.r, extinction(a.r, s.r)),
          channel(medium.emission.g, extinction(a.g, s.g)),
          channel(medium.emission.b, extinction(a.b, s.b))};
}

}  // namespace bandsaw
