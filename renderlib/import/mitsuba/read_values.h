#pragma once

// Reads values of Mitsuba's XML elements from their text: numbers, vectors, colours, spectra.
// Errors are INVALID_ARGUMENT without file and line.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/mitsuba/scene_tree.h"

namespace bandsaw::mitsuba {

/// Returns the parts of a list, which are separated by commas and white space.
std::vector<std::string> parts_of(absl::string_view text);
/// Reads a number, finite and at most 1e30 in absolute value.
absl::StatusOr<double> read_number(absl::string_view text);
absl::StatusOr<std::int64_t> read_integer(absl::string_view text);
absl::StatusOr<bool> read_boolean(absl::string_view text);
/// Reads exactly three numbers.
absl::StatusOr<Vec3> read_three(absl::string_view text);
/// Reads one or three numbers of linear RGB, or "#rrggbb" in sRGB.
absl::StatusOr<Rgb> read_rgb(absl::string_view text);
/// Reads a colour in sRGB: one or three numbers, or "#rrggbb". Returns it as linear RGB.
absl::StatusOr<Rgb> read_srgb(absl::string_view text);
/// Appends a sample to `spectrum`. Returns INVALID_ARGUMENT if `nanometres` is not above the
/// wavelength of the sample before.
absl::Status add_sample(Spectrum& spectrum, double nanometres, double value);
/// Reads a number, or "wavelength:value" pairs with increasing wavelengths in nanometres.
absl::StatusOr<Spectrum> read_spectrum(absl::string_view text);
/// Reads a spectrum file. Each line has a wavelength in nanometres and a value; the wavelengths
/// increase. A line that begins with # is a comment.
absl::StatusOr<Spectrum> read_spectrum_file(absl::string_view text);
/// Reads the 16 numbers of a 4 x 4 matrix, row by row. The last row must be 0 0 0 1. Also reads the
/// 9 numbers of a 3 x 3 matrix, the linear part of a transform without translation.
absl::StatusOr<Transform> read_matrix(absl::string_view text);

}  // namespace bandsaw::mitsuba
