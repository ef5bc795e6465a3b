// Integrates Planck's spectrum with the colour matching functions; the table holds the colour for
// each 1/256 of an octave.

#include "renderlib/medium/blackbody.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// CIE 1931 colour matching functions of the 2 degree observer, 380 nm to 770 nm in steps of 10 nm
/// (CIE 15:2004, table T.4).
constexpr std::array<std::array<double, 3>, 40> kObserver = {{
    {0.0014, 0.0000, 0.0065}, {0.0042, 0.0001, 0.0201}, {0.0143, 0.0004, 0.0679},
    {0.0435, 0.0012, 0.2074}, {0.1344, 0.0040, 0.6456}, {0.2839, 0.0116, 1.3856},
    {0.3483, 0.0230, 1.7471}, {0.3362, 0.0380, 1.7721}, {0.2908, 0.0600, 1.6692},
    {0.1954, 0.0910, 1.2876}, {0.0956, 0.1390, 0.8130}, {0.0320, 0.2080, 0.4652},
    {0.0049, 0.3230, 0.2720}, {0.0093, 0.5030, 0.1582}, {0.0633, 0.7100, 0.0782},
    {0.1655, 0.8620, 0.0422}, {0.2904, 0.9540, 0.0203}, {0.4334, 0.9950, 0.0087},
    {0.5945, 0.9950, 0.0039}, {0.7621, 0.9520, 0.0021}, {0.9163, 0.8700, 0.0017},
    {1.0263, 0.7570, 0.0011}, {1.0622, 0.6310, 0.0008}, {1.0026, 0.5030, 0.0003},
    {0.8544, 0.3810, 0.0002}, {0.6424, 0.2650, 0.0000}, {0.4479, 0.1750, 0.0000},
    {0.2835, 0.1070, 0.0000}, {0.1649, 0.0610, 0.0000}, {0.0874, 0.0320, 0.0000},
    {0.0468, 0.0170, 0.0000}, {0.0227, 0.0082, 0.0000}, {0.0114, 0.0041, 0.0000},
    {0.0058, 0.0021, 0.0000}, {0.0029, 0.0010, 0.0000}, {0.0014, 0.0005, 0.0000},
    {0.0007, 0.0002, 0.0000}, {0.0003, 0.0001, 0.0000}, {0.0002, 0.0001, 0.0000},
    {0.0001, 0.0000, 0.0000},
}};
constexpr double kFirstNm = 380;
constexpr double kStepNm = 10;
/// The second radiation constant, nm K (CODATA 2018).
constexpr double kSecond = 1.438776877e7;
/// Below kMinHue_K the hue is that of kMinHue_K; above kMaxHue_K it is that of kMaxHue_K
/// (blackbody.h).
constexpr double kMinHue_K = 500;
constexpr double kMaxHue_K = 1e5;

/// Linear sRGB before rounding to float.
using Color = std::array<double, 3>;

double luminance_of(const Color& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

/// Returns Planck's spectrum at a wavelength, relative to its maximum.
double relative_planck(double nm, double kelvin) {
  // The maximum is at kSecond / (x T), where x solves x = 5 (1 - exp(-x)).
  constexpr double kPeak = 4.965114231744276;
  const double ratio = kSecond / (nm * kelvin) / kPeak;
  const double fifth = ratio * ratio * ratio * ratio * ratio;
  return fifth * expm1(kPeak) / expm1(kPeak * ratio);
}

/// Returns the colour of a black body at `kelvin` whose spectrum is scaled to a maximum of 1. On
/// this scale, a constant spectrum of 1 has luminance 1. Negative channels become 0, and the other
/// channels are scaled to keep the luminance.
Color peak_color(double kelvin) {
  std::array<double, 3> xyz{};
  double white = 0;
  for (std::size_t i = 0; i < kObserver.size(); ++i) {
    const double power = relative_planck(kFirstNm + kStepNm * static_cast<double>(i), kelvin);
    for (std::size_t k = 0; k < 3; ++k) {
      xyz[k] += power * kObserver[i][k];
    }
    white += kObserver[i][1];
  }
  const auto [x, y, z] = xyz;
  const double all = xyz[1] / white;
  // From XYZ to linear sRGB (IEC 61966-2-1).
  Color rgb = {3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
               0.0557 * x - 0.2040 * y + 1.0570 * z};
  for (double& channel : rgb) {
    channel = std::max(channel, 0.0);
  }
  const double shrink = all / luminance_of(rgb);
  return {rgb[0] * shrink, rgb[1] * shrink, rgb[2] * shrink};
}

Rgb scaled(const Color& c, double by) {
  return {static_cast<float>(c[0] * by), static_cast<float>(c[1] * by),
          static_cast<float>(c[2] * by)};
}

/// The table has 2^8 temperatures for each octave. They are the doubles whose fraction is 0 after
/// its first 8 bits.
constexpr int kFractionBits = 8;
/// The first and the last temperature of the table, 64 K and 131,072 K. They are given by the
/// exponent and the first 8 bits of the fraction of a double.
constexpr std::uint64_t kFirst = std::bit_cast<std::uint64_t>(64.0) >> (52 - kFractionBits);
constexpr std::uint64_t kLast = std::bit_cast<std::uint64_t>(131072.0) >> (52 - kFractionBits);

constexpr double temperature(std::uint64_t entry) {
  return std::bit_cast<double>((kFirst + entry) << (52 - kFractionBits));
}

}  // namespace

Rgb blackbody(double kelvin, BlackbodyScale scale) {
  if (!(kelvin >= kDarkKelvin)) {
    return {};
  }
  const Color color = peak_color(std::clamp(kelvin, kMinHue_K, kMaxHue_K));
  if (scale == BlackbodyScale::kPeak) {
    return scaled(color, 1);
  }
  // kPower: the luminance is (T / 1000 K)^4 / 1000.
  const double ratio = kelvin / 1000;
  return scaled(color, ratio * ratio * ratio * ratio / 1000 / luminance_of(color));
}

BlackbodyTable::BlackbodyTable(BlackbodyScale scale) {
  for (std::uint64_t i = 0; kFirst + i <= kLast; ++i) {
    colors_.push_back(blackbody(temperature(i), scale));
  }
}

Rgb BlackbodyTable::at(double kelvin) const {
  if (!(kelvin >= kDarkKelvin)) {
    return {};
  }
  const double held = std::min(kelvin, temperature(kLast - kFirst));
  const std::uint64_t entry =
      std::min((std::bit_cast<std::uint64_t>(held) >> (52 - kFractionBits)), kLast - 1) - kFirst;
  const double low = temperature(entry);
  const double share = (held - low) / (temperature(entry + 1) - low);
  return lerp(colors_[entry], colors_[entry + 1], static_cast<float>(share));
}

}  // namespace bandsaw
