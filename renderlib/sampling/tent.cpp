// A tent is the linear interpolation kernel of a texel. It rises on one side of the texel's centre
// and falls on the other side. Sampling chooses one of the two sides, and then a point on this
// side. In latitude the density has a factor sin(theta), and Newton's method inverts the
// distribution.

#include "renderlib/sampling/tent.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

constexpr double kTurnsPerRadian = 0.5 * kInvPi;

/// One side of a tent in latitude. It reaches from the row's centre over `width` radians towards
/// theta = 0 (sign -1) or away from theta = 0 (sign +1). At the distance s from the centre, in
/// radians, the density is (1 - s / width) sin(centre + sign s).
struct Side {
  SinCos centre;  ///< sine and cosine of theta at the row's centre
  double sign;
  double width;

  struct At {
    double mass;     ///< integral of the density from 0 to s
    double density;  ///< density at s
  };
  At at(double s) const {
    const SinCos turned = sincos_turns(s * kTurnsPerRadian);
    const double left = 1 - s / width;
    const double along = left * turned.sin + (1 - turned.cos) / width;
    const double across = 1 - left * turned.cos - turned.sin / width;
    return {centre.sin * along + sign * centre.cos * across,
            left * (centre.sin * turned.cos + sign * centre.cos * turned.sin)};
  }
  double mass() const { return at(width).mass; }

  /// Returns the s up to which the integral of the density is u times the total. Uses Newton's
  /// method within a bracket.
  double inverse(double u) const {
    const double target = u * mass();
    double low = 0;
    double high = width;
    // This start would be exact if the sine were constant, so a few steps suffice.
    double s = width * (1 - std::sqrt(1 - u));
    constexpr int kMaxSteps = 12;
    for (int i = 0; i < kMaxSteps; ++i) {
      const At here = at(s);
      (here.mass > target ? high : low) = s;
      const double newton = s - (here.mass - target) / here.density;
      const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
      const double moved = std::abs(next - s);
      s = next;
      if (moved <= 1e-9 * width) {
        break;
      }
    }
    return s;
  }
};

/// The tent of a row: one side above and one below its centre. In the first and the last row, the
/// side towards the pole is a constant 1.
struct LatitudeTent {
  LatitudeTent(std::uint32_t row, std::uint32_t rows)
      : width(kPi / rows),
        theta((row + 0.5) * width),
        centre(sincos_turns(theta * kTurnsPerRadian)),
        first(row == 0),
        last(row + 1 == rows) {}

  Side side(double sign) const { return {centre, sign, width}; }
  /// Returns the solid angle, per radian of longitude, of the cap that extends half a row from a
  /// pole.
  double cap() const {
    const double half = sincos_turns(width * (0.25 * kTurnsPerRadian)).sin;
    return 2 * half * half;
  }
  /// above() and below() return the integral of the density over the side above or below the
  /// centre, per radian of longitude.
  double above() const { return first ? cap() : side(-1).mass(); }
  double below() const { return last ? cap() : side(1).mass(); }

  double width;   ///< width of a row, in radians
  double theta;   ///< angle of the row's centre from the top, in radians
  SinCos centre;  ///< sine and cosine of theta
  bool first;     ///< the row touches the pole at theta = 0
  bool last;      ///< the row touches the other pole
};

}  // namespace

double sample_tent(std::uint32_t index, std::uint32_t texels, Ends ends, double u) {
  const double centre = index + 0.5;
  const bool below = u < 0.5;
  const double rest = below ? 2 * u : 2 * u - 1;
  const bool flat = ends == Ends::kClamped && index == (below ? 0 : texels - 1);
  if (flat) {
    // Towards the border, the tent is 1 over half a texel. This side has the same integral, 1/2, as
    // the other side, which falls from 1 to 0 over a whole texel.
    return below ? 0.5 * rest : centre + 0.5 * rest;
  }
  const double x = below ? centre - 1 + std::sqrt(rest) : centre + 1 - std::sqrt(1 - rest);
  if (ends == Ends::kClamped) {
    return std::clamp(x, 0.0, static_cast<double>(texels));
  }
  return x < 0 ? x + texels : x >= texels ? x - texels : x;
}

double latitude_tent_solid_angle(std::uint32_t row, std::uint32_t rows) {
  const LatitudeTent tent(row, rows);
  return 2 * kPi * (tent.above() + tent.below());
}

double sample_latitude_tent(std::uint32_t row, std::uint32_t rows, double v) {
  const LatitudeTent tent(row, rows);
  const double above = tent.above();
  const double total = above + tent.below();
  const double target = v * total;
  const bool up = target < above;
  const double rest =
      std::clamp(up ? target / above : (target - above) / (total - above), 0.0, kOneMinusEpsilon);
  if (up ? tent.first : tent.last) {
    // 1 - cos of the angle from the pole is uniformly distributed.
    const double from_pole = 2 * asin(std::sqrt(0.5 * rest * tent.cap()));
    return up ? from_pole : kPi - from_pole;
  }
  const double s = tent.side(up ? -1 : 1).inverse(rest);
  return up ? tent.theta - s : tent.theta + s;
}

}  // namespace bandsaw
