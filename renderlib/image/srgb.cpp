// Computes the transfer function of sRGB by the elementary functions of renderlib/math, so that the
// bits are equal on all machines.

#include "renderlib/image/srgb.h"

#include <cmath>

#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

std::array<float, 256> make_table() {
  std::array<float, 256> table{};
  for (int code = 0; code < 256; ++code) {
    table[static_cast<std::size_t>(code)] = static_cast<float>(srgb_decode(code / 255.0));
  }
  return table;
}

}  // namespace

double srgb_decode(double v) {
  return v <= 0.04045 ? v / 12.92 : bandsaw::pow((v + 0.055) / 1.055, 2.4);
}

double srgb_curve(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * bandsaw::pow(linear, 1 / 2.4) - 0.055;
}

const std::array<float, 256>& srgb_table() {
  static const std::array<float, 256> table = make_table();
  return table;
}

std::uint8_t srgb_encode(float linear) {
  if (!(linear > 0)) {
    return 0;
  }
  if (linear >= 1) {
    return 255;
  }
  return static_cast<std::uint8_t>(std::floor(255 * srgb_curve(linear) + 0.5));
}

}  // namespace bandsaw
