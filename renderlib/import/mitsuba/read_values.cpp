// Reads values of a Mitsuba scene: splits a text at commas and spaces, and converts the parts to
// the numbers that the type of the value requires.

#include "renderlib/import/mitsuba/read_values.h"

#include <cmath>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/srgb.h"

namespace bandsaw::mitsuba {
namespace {

constexpr double kMaxNumber = 1e30;

/// Returns the error that `text` is not `what`. A long text is shortened.
absl::Status not_a(const char* what, absl::string_view text) {
  constexpr std::size_t kShown = 60;
  return absl::InvalidArgumentError(absl::StrCat(
      "\"", text.substr(0, kShown), text.size() > kShown ? "…" : "", "\" is not ", what));
}

/// Reads numbers that are separated by commas or white space.
absl::StatusOr<std::vector<double>> read_list(absl::string_view text) {
  std::vector<double> numbers;
  for (const std::string& part : parts_of(text)) {
    ASSIGN_OR_RETURN(const double number, read_number(part));
    numbers.push_back(number);
  }
  return numbers;
}

/// Reads "#rrggbb" and decodes it from sRGB to linear RGB.
absl::StatusOr<Rgb> read_hex(absl::string_view text) {
  std::uint32_t bits = 0;
  if (text.size() != 7 || !absl::SimpleHexAtoi(text.substr(1), &bits)) {
    return not_a("a colour #rrggbb", text);
  }
  const auto channel = [&](int shift) {
    return static_cast<float>(srgb_decode(static_cast<double>((bits >> shift) & 255) / 255));
  };
  return Rgb{channel(16), channel(8), channel(0)};
}

/// Returns the colour of three channels, or the grey of one.
Rgb rgb_of(const std::vector<double>& numbers) {
  const auto channel = [&](std::size_t i) {
    return static_cast<float>(numbers.size() == 1 ? numbers[0] : numbers[i]);
  };
  return {channel(0), channel(1), channel(2)};
}

/// Returns the spectrum, or INVALID_ARGUMENT if it has fewer than two samples.
absl::StatusOr<Spectrum> with_enough_samples(Spectrum spectrum) {
  if (spectrum.samples.size() < 2) {
    return absl::InvalidArgumentError("a sampled spectrum needs at least two wavelengths");
  }
  return spectrum;
}

}  // namespace

absl::Status add_sample(Spectrum& spectrum, double nanometres, double value) {
  if (!spectrum.samples.empty() && nanometres <= spectrum.samples.back().nanometres) {
    return absl::InvalidArgumentError(
        absl::StrCat("the wavelengths of a spectrum must increase: ", nanometres, " follows ",
                     spectrum.samples.back().nanometres));
  }
  spectrum.samples.push_back({nanometres, value});
  return absl::OkStatus();
}

std::vector<std::string> parts_of(absl::string_view text) {
  return absl::StrSplit(text, absl::ByAnyChar(", \t\r\n"), absl::SkipEmpty());
}

absl::StatusOr<double> read_number(absl::string_view text) {
  double number = 0;
  const absl::string_view trimmed = absl::StripAsciiWhitespace(text);
  if (!absl::SimpleAtod(trimmed, &number)) {
    return not_a("a number", text);
  }
  if (!(std::abs(number) <= kMaxNumber)) {
    return not_a("a finite number of at most 1e30", text);
  }
  return number;
}

absl::StatusOr<std::int64_t> read_integer(absl::string_view text) {
  std::int64_t number = 0;
  if (!absl::SimpleAtoi(absl::StripAsciiWhitespace(text), &number)) {
    return not_a("a whole number", text);
  }
  return number;
}

absl::StatusOr<bool> read_boolean(absl::string_view text) {
  const std::string lower = absl::AsciiStrToLower(absl::StripAsciiWhitespace(text));
  if (lower != "true" && lower != "false") {
    return not_a("true or false", text);
  }
  return lower == "true";
}

absl::StatusOr<Vec3> read_three(absl::string_view text) {
  ASSIGN_OR_RETURN(const std::vector<double> numbers, read_list(text));
  if (numbers.size() != 3) {
    return not_a("a list of three numbers", text);
  }
  return Vec3{numbers[0], numbers[1], numbers[2]};
}

absl::StatusOr<Rgb> read_rgb(absl::string_view text) {
  const absl::string_view trimmed = absl::StripAsciiWhitespace(text);
  if (absl::StartsWith(trimmed, "#")) {
    return read_hex(trimmed);
  }
  ASSIGN_OR_RETURN(const std::vector<double> numbers, read_list(text));
  if (numbers.size() != 1 && numbers.size() != 3) {
    return not_a("a colour of one number or three", text);
  }
  return rgb_of(numbers);
}

absl::StatusOr<Rgb> read_srgb(absl::string_view text) {
  ASSIGN_OR_RETURN(const Rgb color, read_rgb(text));
  if (absl::StartsWith(absl::StripAsciiWhitespace(text), "#")) {
    return color;
  }
  const auto decoded = [](float c) { return static_cast<float>(srgb_decode(c)); };
  return Rgb{decoded(color.r), decoded(color.g), decoded(color.b)};
}

absl::StatusOr<Spectrum> read_spectrum(absl::string_view text) {
  Spectrum spectrum;
  const std::vector<std::string> parts = parts_of(text);
  if (parts.size() == 1 && !absl::StrContains(parts[0], ':')) {
    ASSIGN_OR_RETURN(spectrum.constant, read_number(parts[0]));
    return spectrum;
  }
  for (const std::string& part : parts) {
    const std::pair<std::string, std::string> pair = absl::StrSplit(part, absl::MaxSplits(':', 1));
    if (!absl::StrContains(part, ':')) {
      return not_a("a number or pairs of wavelength:value", text);
    }
    ASSIGN_OR_RETURN(const double nanometres, read_number(pair.first));
    ASSIGN_OR_RETURN(const double value, read_number(pair.second));
    RETURN_IF_ERROR(add_sample(spectrum, nanometres, value));
  }
  return with_enough_samples(std::move(spectrum));
}

absl::StatusOr<Spectrum> read_spectrum_file(absl::string_view text) {
  Spectrum spectrum;
  for (const absl::string_view line : absl::StrSplit(text, '\n')) {
    const absl::string_view trimmed = absl::StripAsciiWhitespace(line);
    if (trimmed.empty() || trimmed[0] == '#') {
      continue;
    }
    ASSIGN_OR_RETURN(const std::vector<double> numbers, read_list(trimmed));
    if (numbers.size() != 2) {
      return not_a("a line of wavelength and value", trimmed);
    }
    RETURN_IF_ERROR(add_sample(spectrum, numbers[0], numbers[1]));
  }
  return with_enough_samples(std::move(spectrum));
}

absl::StatusOr<Transform> read_matrix(absl::string_view text) {
  ASSIGN_OR_RETURN(const std::vector<double> numbers, read_list(text));
  if (numbers.size() != 16 && numbers.size() != 9) {
    return not_a("a matrix of 16 or 9 numbers", text);
  }
  Transform to;
  const std::size_t columns = numbers.size() == 16 ? 4 : 3;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      to.m[row][column] = numbers[row * columns + column];
    }
  }
  if (columns == 4 &&
      (numbers[12] != 0 || numbers[13] != 0 || numbers[14] != 0 || numbers[15] != 1)) {
    return absl::InvalidArgumentError("the last row of a matrix must be 0 0 0 1");
  }
  return to;
}

}  // namespace bandsaw::mitsuba
