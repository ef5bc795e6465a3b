#pragma once

// Converts spectra of Mitsuba scenes to linear RGB, as Mitsuba does in its variants that render in
// RGB.

#include "absl/status/statusor.h"
#include "renderlib/import/mitsuba/parameters.h"
#include "renderlib/import/mitsuba/textures.h"
#include "renderlib/math/rgb.h"

namespace bandsaw::mitsuba {

/// Returns the colour of a spectrum. The spectrum of a surface is multiplied by the illuminant D65.
/// The spectrum of a light is not. Channels below 0 become 0.
Rgb rgb_of(const Spectrum& spectrum, ColorOf of);
/// Returns the colour of the radiance of a black body, with the temperature clamped to [100, 1e5]
/// K.
Rgb rgb_of(const BlackBody& body);
/// Reads the parameters of a spectrum of type "regular" or "irregular".
absl::StatusOr<Spectrum> sampled_spectrum(const Parameters& from);

/// Returns the index of refraction that a parameter gives as a number or by the name of a material
/// ("bk7"). `otherwise` is the name of the material if the parameter is absent. Returns
/// INVALID_ARGUMENT for a number that is not above 0 and for an unknown name.
absl::StatusOr<double> index_of_refraction(const Parameters& from, const std::string& name,
                                           const std::string& otherwise);

/// Complex index of refraction for each channel: `eta` is its real part, `k` its imaginary part.
struct MetalIndex {
  Rgb eta;
  Rgb k;
};
/// Returns the complex index of the metal with this name ("Cu"); NOT_FOUND if the name is not
/// known.
absl::StatusOr<MetalIndex> metal_of(const std::string& name);

}  // namespace bandsaw::mitsuba
