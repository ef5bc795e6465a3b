// Henyey and Greenstein's phase function and its sampling, in forms that are exact at g = 0 and
// near the peak.

#include "renderlib/medium/phase.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/sampling/basis.h"

namespace bandsaw {
namespace {

/// Inverts the distribution function of the cosine for k = 2 u - 1. The usual form of the inverse
/// divides by g; this form does not.
double sample_cosine(double g, double k) {
  const double numerator = 2 * k + g * (k * k + 3) + 2 * g * g * k + g * g * g * (k * k - 1);
  const double denominator = 1 + g * k;
  return std::clamp(numerator / (2 * denominator * denominator), -1.0, 1.0);
}

}  // namespace

double phase(double g, double cosine) {
  // (1 - g)^2 + 2 g (1 - cosine): no cancellation near the peak.
  const double base =
      g >= 0 ? (1 - g) * (1 - g) + 2 * g * (1 - cosine) : (1 + g) * (1 + g) - 2 * g * (1 + cosine);
  return 0.25 * kInvPi * (1 - g) * (1 + g) / (base * std::sqrt(base));
}

Vec3 sample_phase(double g, const Vec3& direction, double u, double v) {
  const double cosine = sample_cosine(g, 2 * u - 1);
  const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
  const SinCos turn = sincos_turns(v);
  return normalize(
      orthonormal_basis(direction).to_world({sine * turn.cos, sine * turn.sin, cosine}));
}

}  // namespace bandsaw
