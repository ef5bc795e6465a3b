// A table of the directional albedo of GGX over cosine and roughness, computed by quadrature when
// it is first used. `white` is for a Fresnel term of 1, `rim` for Schlick's (1 - cos)^5.

#include "renderlib/material/ggx_albedo.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/fresnel.h"
#include "renderlib/material/ggx.h"

namespace bandsaw {
namespace {

GgxAlbedo mixed(const GgxAlbedo& a, const GgxAlbedo& b, double t) {
  return {a.white + (b.white - a.white) * t, a.rim + (b.rim - a.rim) * t};
}

/// Returns the albedo for a direction with this cosine to the normal. It is integrated by the
/// midpoint rule over the unit square of the numbers (u, v) with which sample_ggx_visible() chooses
/// a normal. The integrand is the shadowing term, which is at most 1. Values of v near 1 sample the
/// tail of the distribution, so points are denser near v = 1. With these numbers of points the
/// table is within 2e-3 of the integral (tests).
GgxAlbedo integrated(double cos_theta, double alpha) {
  constexpr int kTurns = 16;
  constexpr int kHeights = 48;
  const Vec3 o{std::sqrt(1 - cos_theta * cos_theta), 0, cos_theta};
  GgxAlbedo sum;
  for (int a = 0; a < kTurns; ++a) {
    for (int b = 0; b < kHeights; ++b) {
      const double left = 1 - (b + 0.5) / kHeights;
      // Half a turn suffices: the surface is isotropic.
      const Vec3 h = sample_ggx_visible(o, alpha, 0.5 * (a + 0.5) / kTurns, 1 - left * left);
      const Vec3 i = mirrored(o, h);
      if (i.z <= 0) {
        continue;
      }
      const double seen = 2 * left * ggx_shadowing(o, i, alpha) / (kTurns * kHeights);
      sum.white += seen;
      sum.rim += seen * schlick_rim(dot(o, h));
    }
  }
  return sum;
}

}  // namespace

// Fills the table, and for each roughness the mean over directions weighted by their cosine.
GgxAlbedoTable::GgxAlbedoTable() {
  for (int r = 0; r <= kRoughnesses; ++r) {
    const double roughness = static_cast<double>(r) / kRoughnesses;
    const double alpha = std::max(kMinAlpha, roughness * roughness);
    auto& row = values_[static_cast<std::size_t>(r)];
    for (int c = 0; c <= kCosines; ++c) {
      // The cosines are denser at grazing angles, where the albedo changes most.
      const double root = static_cast<double>(c) / kCosines;
      row[static_cast<std::size_t>(c)] = integrated(std::max(1e-4, root * root), alpha);
    }
    GgxAlbedo& mean = means_[static_cast<std::size_t>(r)];
    constexpr int kSteps = 64;
    for (int i = 0; i < kSteps; ++i) {
      const double cos_theta = (i + 0.5) / kSteps;
      const GgxAlbedo value = at(cos_theta, roughness);
      mean.white += value.white * 2 * cos_theta / kSteps;
      mean.rim += value.rim * 2 * cos_theta / kSteps;
    }
  }
}

GgxAlbedo GgxAlbedoTable::at(double cos_theta, double roughness) const {
  const double x = std::sqrt(std::clamp(cos_theta, 0.0, 1.0)) * kCosines;
  const double y = std::clamp(roughness, 0.0, 1.0) * kRoughnesses;
  const int column = std::min(static_cast<int>(x), kCosines - 1);
  const int row = std::min(static_cast<int>(y), kRoughnesses - 1);
  const auto of = [&](int r) {
    const auto& values = values_[static_cast<std::size_t>(r)];
    const auto left = static_cast<std::size_t>(column);
    return mixed(values[left], values[left + 1], x - column);
  };
  // The constructor calls at() for the roughness of one row while later rows are not computed yet.
  // So only this row is read if the roughness is exactly that of a row.
  return y == row            ? of(row)
         : y == kRoughnesses ? of(kRoughnesses)
                             : mixed(of(row), of(row + 1), y - row);
}

GgxAlbedo GgxAlbedoTable::mean(double roughness) const {
  const double y = std::clamp(roughness, 0.0, 1.0) * kRoughnesses;
  const int row = std::min(static_cast<int>(y), kRoughnesses - 1);
  const auto r = static_cast<std::size_t>(row);
  return mixed(means_[r], means_[r + 1], y - row);
}

const GgxAlbedoTable& ggx_albedo_table() {
  static const GgxAlbedoTable table;
  return table;
}

}  // namespace bandsaw
