// Applies the exposure and the filmic tone curve, a rational function of each channel.

#include "renderlib/image/display.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Returns the value of the curve Tone::kFilmic.
float filmic(float light) {
  if (std::isnan(light)) {
    return light;
  }
  // The curve exceeds 1 from 7.25 on. Without the clamp, the quotient would be NaN for infinite
  // light.
  const double x = std::clamp(double{light}, 0.0, 1e6);
  return static_cast<float>(std::min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)));
}

}  // namespace

absl::string_view tone_name(Tone tone) { return tone == Tone::kFilmic ? "filmic" : "none"; }

std::optional<Tone> tone_named(absl::string_view name) {
  for (const Tone tone : {Tone::kNone, Tone::kFilmic}) {
    if (tone_name(tone) == name) {
      return tone;
    }
  }
  return std::nullopt;
}

Rgb shown(const Rgb& light, const Display& display) {
  Rgb rgb = light;
  if (display.exposure != 0) {
    rgb = rgb * static_cast<float>(pow(2, display.exposure));
  }
  if (display.tone == Tone::kFilmic) {
    rgb = {filmic(rgb.r), filmic(rgb.g), filmic(rgb.b)};
  }
  return rgb;
}

}  // namespace bandsaw
