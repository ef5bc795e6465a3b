#pragma once

// Converts spectra to linear RGB with sRGB primaries, by the CIE 1931 standard observer (2
// degrees). Used by the converters of pbrt and Mitsuba, whose scenes contain spectra.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw::spectrum {

/// Linear RGB, sRGB primaries (IEC 61966-2-1). A channel may be negative.
using Rgb3 = std::array<double, 3>;

/// A spectrum by its values at increasing wavelengths (nm), linear between them.
struct Sampled {
  std::vector<double> wavelengths;
  std::vector<double> values;

  /// Returns the value at a wavelength in nanometres. Below the first wavelength it is the first
  /// value, and above the last wavelength it is the last value.
  double at(double nm) const;
};

/// Returns the spectrum of pairs of a wavelength and a value. Returns INVALID_ARGUMENT if the last
/// pair is incomplete, if there are no pairs or more than 100,000 pairs, if a number is not finite,
/// or if the wavelengths do not increase.
absl::StatusOr<Sampled> from_pairs(const std::vector<double>& numbers);

/// Parses a file of pairs, with one pair on each line (*.spd); # begins a comment. Errors are those
/// of from_pairs(), and INVALID_ARGUMENT for a word that is no number.
absl::StatusOr<Sampled> parse_spd(absl::string_view text);

/// Returns the spectrum with 0 outside of its wavelengths. This is how pbrt and Mitsuba integrate
/// the spectra that a scene defines.
Sampled zero_outside(const Sampled& from);

/// Returns the visible radiation of a black body, relative to its maximum over all wavelengths. The
/// maximum may be at an invisible wavelength. `kelvin` > 0.
Sampled blackbody(double kelvin);

/// Returns the colour of a light: the integral with the colour matching functions, scaled so that
/// an equal-energy spectrum of value 1 has luminance 1.
Rgb3 light_rgb(const Sampled& light);
/// Returns light_rgb() scaled to luminance 1; [1, 1, 1] for a dark spectrum.
Rgb3 light_rgb_of_luminance_1(const Sampled& light);
/// Returns the luminance of linear RGB.
double luminance(const Rgb3& rgb);

/// Returns the colour of a reflectance, or any other factor: the RGB of D65 times `factor`, divided
/// by the RGB of D65. A constant spectrum has three equal channels.
Rgb3 factor_rgb(const Sampled& factor);

/// Complex index of refraction of a metal for each channel.
struct Metal {
  Rgb3 eta;
  Rgb3 k;
};
/// Returns an index of refraction for each channel. The reflectance of the channels at normal
/// incidence is factor_rgb() of the spectral reflectance, which is the colour that a spectral
/// renderer shows. eta of a channel is factor_rgb() of the spectrum `eta`, and k is computed from
/// eta and the reflectance.
Metal metal_rgb(const Sampled& eta, const Sampled& k);

/// Returns a spectrum by the name that it has in pbrt. The names are "stdillum-D65", "stdillum-A",
/// "metal-Cu-eta" and "metal-Cu-k" (also with Ag, Al, Au, CuZn, MgO or TiO2), and "glass-BK7" (also
/// with BAF10, FK51A, LASF9, F5, F10 or F11). Returns std::nullopt for other names.
std::optional<Sampled> named(absl::string_view name);

/// Wavelength of the d line in nanometres, at which indices of refraction are stated.
inline constexpr double kLineD = 587.56;

}  // namespace bandsaw::spectrum
