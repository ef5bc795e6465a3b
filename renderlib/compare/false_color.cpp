// Interpolates between six colours in sRGB codes, so that equal differences of the values look
// equally large, and converts the result to linear RGB.

#include "renderlib/compare/false_color.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderlib/image/srgb.h"

namespace bandsaw {
namespace {

// The colours of evenly spaced values, as sRGB codes. Their lightness rises in even steps.
using Code = std::array<double, 3>;
constexpr std::array<Code, 6> kStops = {
    {{0, 0, 0}, {58, 9, 99}, {150, 38, 103}, {221, 81, 58}, {252, 165, 10}, {252, 255, 220}}};

// Returns the linear value of the sRGB code that is nearest to `code`.
float linear(double code) { return srgb_table()[static_cast<std::size_t>(std::lround(code))]; }

// Returns the colour of a value, which is clamped to [0, 1], in linear RGB.
Rgb color_of(double value) {
  const double at = std::clamp(value, 0.0, 1.0) * (kStops.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double share = at - static_cast<double>(below);
  const auto mixed = [&](std::size_t channel) {
    return linear(kStops[below][channel] * (1 - share) + kStops[below + 1][channel] * share);
  };
  return {mixed(0), mixed(1), mixed(2)};
}

}  // namespace

Image false_color(const Plane& values) {
  Image out{.width = values.width, .height = values.height, .pixels = {}};
  out.pixels.resize(values.values.size());
  std::transform(values.values.begin(), values.values.end(), out.pixels.begin(), color_of);
  return out;
}

}  // namespace bandsaw
