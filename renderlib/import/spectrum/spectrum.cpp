// Converts spectra to colours: integrates them with the colour matching functions to XYZ, and
// converts XYZ to linear RGB.

#include "renderlib/import/spectrum/spectrum.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/spectrum/observer.h"
#include "renderlib/math/elementary.h"

namespace bandsaw::spectrum {
namespace {

/// Maximum count of numbers of a spectrum: 100,000 pairs.
constexpr std::size_t kMaxNumbers = 200'000;

/// Converts XYZ to linear RGB with sRGB primaries and the white point D65 (IEC 61966-2-1).
Rgb3 rgb_of_xyz(const Rgb3& xyz) {
  constexpr double kMatrix[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                    {-0.9692660, 1.8760108, 0.0415560},
                                    {0.0556434, -0.2040259, 1.0572252}};
  Rgb3 rgb = {};
  for (std::size_t row = 0; row < 3; ++row) {
    rgb[row] = kMatrix[row][0] * xyz[0] + kMatrix[row][1] * xyz[1] + kMatrix[row][2] * xyz[2];
  }
  return rgb;
}

/// Integrates f(nm) with the colour matching functions in steps of 1 nm, and divides by the
/// integral of the luminosity function.
template <class F>
Rgb3 xyz_of(const F& f) {
  Rgb3 sum = {};
  double norm = 0;
  for (int nm = kFirstNm; nm <= kLastNm; ++nm) {
    const double value = f(nm);
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += value * observer(k, nm);
    }
    norm += observer(1, nm);
  }
  return {sum[0] / norm, sum[1] / norm, sum[2] / norm};
}

}  // namespace

double Sampled::at(double nm) const {
  const auto next = std::upper_bound(wavelengths.begin(), wavelengths.end(), nm);
  if (next == wavelengths.begin()) {
    return values.front();
  }
  if (next == wavelengths.end()) {
    return values.back();
  }
  const auto i = static_cast<std::size_t>(next - wavelengths.begin());
  const double share = (nm - wavelengths[i - 1]) / (wavelengths[i] - wavelengths[i - 1]);
  return values[i - 1] + share * (values[i] - values[i - 1]);
}

absl::StatusOr<Sampled> from_pairs(const std::vector<double>& numbers) {
  if (numbers.empty() || numbers.size() % 2 != 0 || numbers.size() > kMaxNumbers) {
    return absl::InvalidArgumentError(absl::StrCat(
        "a spectrum must be 1 to 100,000 pairs of a wavelength and a value; there are ",
        numbers.size(), " numbers"));
  }
  Sampled out;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    if (!std::isfinite(numbers[i]) || !std::isfinite(numbers[i + 1]) ||
        (i > 0 && !(numbers[i] > numbers[i - 2]))) {
      return absl::InvalidArgumentError(
          absl::StrCat("pair ", i / 2 + 1,
                       " of a spectrum must have finite numbers, and a wavelength above the "
                       "wavelength of the pair before"));
    }
    out.wavelengths.push_back(numbers[i]);
    out.values.push_back(numbers[i + 1]);
  }
  return out;
}

absl::StatusOr<Sampled> parse_spd(absl::string_view text) {
  std::vector<double> numbers;
  for (absl::string_view line : absl::StrSplit(text, '\n')) {
    line = line.substr(0, line.find('#'));
    for (const absl::string_view word :
         absl::StrSplit(line, absl::ByAnyChar(" \t\r,"), absl::SkipEmpty())) {
      double number = 0;
      if (!absl::SimpleAtod(word, &number)) {
        return absl::InvalidArgumentError(
            absl::StrCat("\"", word.substr(0, 40), "\" is no number"));
      }
      numbers.push_back(number);
      if (numbers.size() > kMaxNumbers) {
        return from_pairs(numbers);  // returns the error for too many numbers
      }
    }
  }
  return from_pairs(numbers);
}

Sampled zero_outside(const Sampled& from) {
  constexpr double kStep = 1e-6;  // nm
  Sampled to = from;
  to.wavelengths.insert(to.wavelengths.begin(), from.wavelengths.front() - kStep);
  to.values.insert(to.values.begin(), 0);
  to.wavelengths.push_back(from.wavelengths.back() + kStep);
  to.values.push_back(0);
  return to;
}

Sampled blackbody(double kelvin) {
  // Planck's law, divided by its value at the peak, whose wavelength is kWien / kelvin. kSecond is
  // the second radiation constant hc / k_B, and kWien is Wien's displacement constant. Both have
  // the unit nm K.
  constexpr double kSecond = 1.438776877e7;
  constexpr double kWien = 2.897771955e6;
  const auto planck = [kelvin](double nm) {
    const double um = nm / 1000;
    return 1 / (um * um * um * um * um * expm1(kSecond / (nm * kelvin)));
  };
  const double peak = planck(kWien / kelvin);
  Sampled out;
  for (int nm = kFirstNm; nm <= kLastNm; nm += 5) {
    out.wavelengths.push_back(nm);
    out.values.push_back(planck(nm) / peak);
  }
  return out;
}

double luminance(const Rgb3& rgb) {
  return 0.2126729 * rgb[0] + 0.7151522 * rgb[1] + 0.0721750 * rgb[2];
}

Rgb3 light_rgb(const Sampled& light) {
  return rgb_of_xyz(xyz_of([&](int nm) { return light.at(nm); }));
}

Rgb3 light_rgb_of_luminance_1(const Sampled& light) {
  const Rgb3 rgb = light_rgb(light);
  const double y = luminance(rgb);
  return y > 0 ? Rgb3{rgb[0] / y, rgb[1] / y, rgb[2] / y} : Rgb3{1, 1, 1};
}

Rgb3 factor_rgb(const Sampled& factor) {
  const Rgb3 lit = rgb_of_xyz(xyz_of([&](int nm) { return factor.at(nm) * daylight(nm); }));
  const Rgb3 white = rgb_of_xyz(xyz_of([](int nm) { return daylight(nm); }));
  return {lit[0] / white[0], lit[1] / white[1], lit[2] / white[2]};
}

Metal metal_rgb(const Sampled& eta, const Sampled& k) {
  const auto reflectance = [](double n, double absorption) {
    const double k2 = absorption * absorption;
    return ((n - 1) * (n - 1) + k2) / ((n + 1) * (n + 1) + k2);
  };
  Sampled reflected;
  for (int nm = kFirstNm; nm <= kLastNm; nm += 5) {
    reflected.wavelengths.push_back(nm);
    reflected.values.push_back(reflectance(eta.at(nm), k.at(nm)));
  }
  const Rgb3 n = factor_rgb(eta);
  const Rgb3 f = factor_rgb(reflected);
  Metal metal;
  for (std::size_t c = 0; c < 3; ++c) {
    metal.eta[c] = std::clamp(n[c], 1e-3, 100.0);
    const double most = 0.9999;
    const double target = std::clamp(f[c], 0.0, most);
    const double more = metal.eta[c] + 1;
    const double less = metal.eta[c] - 1;
    // Solves ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2) = target for k^2.
    const double square = (target * more * more - less * less) / (1 - target);
    metal.k[c] = std::clamp(std::sqrt(std::max(square, 0.0)), 0.0, 100.0);
  }
  return metal;
}

}  // namespace bandsaw::spectrum
