// Evaluates checker, noise, turbulence, marble and ramp.

#include "renderlib/texture/procedural.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/texture/blend.h"
#include "renderlib/texture/noise.h"

namespace bandsaw {
namespace {

/// Returns 0 or 1, alternating from cell to cell; 0 if x is not finite. Each cell begins early, by
/// `slack`, so that a plane on a border between cells has one texture.
double parity(double x, double slack) {
  const double cell = std::floor(x + slack);
  const double bit = cell - 2 * std::floor(cell / 2);
  return std::isfinite(bit) ? bit : 0;
}

/// Returns the margin by which cells begin early, in cells. It is at least 2^-20, and larger than
/// the rounding error of coordinates as large as `largest`.
double slack_of(double largest) { return 0x1p-20 + 0x1p-40 * largest; }

/// Returns t of NoiseTexture before clamping to [0, 1].
double unclamped_t(const NoiseTexture& texture, const Vec3& p) {
  switch (texture.kind) {
    case NoiseTexture::Kind::kNoise:
      return 0.5 * (1 + noise(texture.scale * p));
    case NoiseTexture::Kind::kTurbulence:
      return turbulence(texture.scale * p, texture.octaves);
    case NoiseTexture::Kind::kMarble:
      break;
  }
  const double veins = texture.strength * turbulence(texture.turbulence_scale * p, texture.octaves);
  const double phase = texture.scale * dot(texture.axis, p) + veins;
  return std::isfinite(phase) ? 0.5 * (1 + sincos_turns(phase * (0.5 * kInvPi)).sin) : 0.5;
}

}  // namespace

bool is_even(const CheckerTexture& checker, const TextureCoordinates& at) {
  if (checker.mapping == CheckerTexture::Mapping::kUv) {
    const Vec2& uv = at.of(checker.uv_set);
    const double u = uv.x / checker.size.x;
    const double v = uv.y / checker.size.y;
    const double slack = slack_of(std::max(std::abs(u), std::abs(v)));
    return parity(u, slack) == parity(v, slack);
  }
  const Vec3& p = at.of(checker.space);
  const Vec3 cells{p.x / checker.size.x, p.y / checker.size.y, p.z / checker.size.z};
  const double slack = slack_of(max_abs(cells));
  const double sum = parity(cells.x, slack) + parity(cells.y, slack) + parity(cells.z, slack);
  return sum == 0 || sum == 2;
}

Rgb evaluate(const NoiseTexture& texture, const TextureCoordinates& at) {
  const double t = std::clamp(unclamped_t(texture, at.of(texture.space)), 0.0, 1.0);
  return blend(texture.low, texture.high, static_cast<float>(t));
}

double repetitions(const CheckerTexture& checker, const TextureCoordinates& change) {
  const Vec3& size = checker.size;
  if (checker.mapping == CheckerTexture::Mapping::kUv) {
    const Vec2& uv = change.of(checker.uv_set);
    return max_abs({uv.x / size.x, uv.y / size.y, 0});
  }
  const Vec3& p = change.of(checker.space);
  return max_abs({p.x / size.x, p.y / size.y, p.z / size.z});
}

double repetitions(const NoiseTexture& texture, const TextureCoordinates& change) {
  const Vec3& p = change.of(texture.space);
  if (texture.kind != NoiseTexture::Kind::kMarble) {
    return max_abs(texture.scale * p);
  }
  // Marble repeats with the cells of its turbulence, and with the period 2 pi of its sine.
  const double cells = max_abs(texture.turbulence_scale * p);
  const double phase =
      std::abs(texture.scale * dot(texture.axis, p)) + std::abs(texture.strength) * cells;
  return std::max(cells, phase * (0.5 * kInvPi));
}

double repetitions(const RampTexture& ramp, const TextureCoordinates& change) {
  const double range = ramp.stops.back().at - ramp.stops.front().at;
  return range > 0 ? std::abs(coordinate(ramp, change)) / range : 0;
}

double coordinate(const RampTexture& ramp, const TextureCoordinates& at) {
  const Vec2& uv = at.of(ramp.uv_set);
  const Vec3& p = at.of(ramp.space);
  switch (ramp.over) {
    case RampTexture::Over::kU:
      return uv.x;
    case RampTexture::Over::kV:
      return uv.y;
    case RampTexture::Over::kX:
      return p.x;
    case RampTexture::Over::kY:
      return p.y;
    case RampTexture::Over::kZ:
      return p.z;
    case RampTexture::Over::kTexture:
      break;
  }
  return 0;
}

Rgb evaluate(const RampTexture& ramp, double value) {
  // The values of a texture are floats. So the stops of a stepped ramp over a texture are rounded
  // to floats, too.
  const bool in_floats = ramp.steps && ramp.over == RampTexture::Over::kTexture;
  const auto next =
      std::find_if(ramp.stops.begin(), ramp.stops.end(), [&](const RampTexture::Stop& stop) {
        return !((in_floats ? double{static_cast<float>(stop.at)} : stop.at) <= value);
      });
  if (next == ramp.stops.begin()) {
    return next->color;
  }
  const RampTexture::Stop& before = *(next - 1);
  if (next == ramp.stops.end() || ramp.steps) {
    return before.color;
  }
  const double t = (value - before.at) / (next->at - before.at);
  return blend(before.color, next->color, static_cast<float>(t));
}

}  // namespace bandsaw
