// Converts the spectra of Mitsuba scenes to RGB with renderlib/import/spectrum. Holds the tables of
// metals and of indices of refraction.

#include "renderlib/import/mitsuba/spectra.h"

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/read_values.h"
#include "renderlib/import/spectrum/spectrum.h"

namespace bandsaw::mitsuba {
namespace {

/// Rounds the channels to float. Channels below 0 become 0.
Rgb rounded(const spectrum::Rgb3& c) {
  const auto channel = [](double v) { return static_cast<float>(std::max(v, 0.0)); };
  return {channel(c[0]), channel(c[1]), channel(c[2])};
}

/// Wavelengths of the tables of metals, in nanometres.
const std::vector<double>& metal_wavelengths() {
  static const std::vector<double> all = {380, 410, 440, 470, 500, 530, 560,
                                          590, 620, 650, 680, 710, 740, 780};
  return all;
}

struct MetalTable {
  std::array<double, 14> eta;
  std::array<double, 14> k;
};

/// Optical constants of metals at metal_wavelengths(): Palik (ed.), "Handbook of Optical Constants
/// of Solids", 1985, and the tables of luxpop.com, interpolated.
const std::map<std::string, MetalTable>& metals() {
  static const std::map<std::string, MetalTable> all = {
      {"Ag",
       {{0.195, 0.173, 0.158, 0.137, 0.13, 0.129, 0.121, 0.121, 0.131, 0.139, 0.14, 0.144, 0.147,
         0.143},
        {1.72, 2.071, 2.374, 2.658, 2.918, 3.177, 3.421, 3.657, 3.881, 4.129, 4.37, 4.597, 4.822,
         5.13}}},
      {"Al",
       {{0.442, 0.515, 0.591, 0.675, 0.769, 0.876, 1.004, 1.148, 1.3, 1.475, 1.674, 1.927, 2.271,
         2.665},
        {4.615, 4.981, 5.347, 5.715, 6.078, 6.447, 6.807, 7.146, 7.481, 7.794, 8.115, 8.403, 8.594,
         8.569}}},
      {"Au",
       {{1.689, 1.641, 1.572, 1.314, 0.851, 0.473, 0.317, 0.237, 0.194, 0.168, 0.161, 0.162, 0.167,
         0.177},
        {1.915, 1.958, 1.911, 1.815, 1.887, 2.371, 2.838, 2.969, 3.06, 3.143, 3.632, 4.092, 4.475,
         4.912}}},
      {"Cr",
       {{1.436, 1.546, 1.82, 2.199, 2.606, 2.956, 3.19, 3.379, 3.517, 3.638, 3.758, 3.872, 3.974,
         4.109},
        {3.365, 3.719, 4.077, 4.347, 4.449, 4.451, 4.408, 4.374, 4.361, 4.364, 4.368, 4.368, 4.36,
         4.349}}},
      {"Cu",
       {{1.209, 1.179, 1.171, 1.154, 1.132, 1.081, 0.861, 0.473, 0.272, 0.217, 0.211, 0.218, 0.229,
         0.251},
        {2.086, 2.19, 2.349, 2.476, 2.572, 2.593, 2.593, 2.805, 3.241, 3.638, 3.962, 4.249, 4.521,
         4.861}}},
      {"Hg",
       {{0.77, 0.885, 1.015, 1.154, 1.301, 1.451, 1.602, 1.756, 1.911, 2.073, 2.236, 2.398, 2.559,
         2.773},
        {3.223, 3.507, 3.777, 4.032, 4.275, 4.505, 4.725, 4.938, 5.151, 5.339, 5.527, 5.698, 5.863,
         6.077}}},
      {"Ni_palik",
       {{1.61, 1.61, 1.62, 1.652, 1.678, 1.734, 1.793, 1.849, 1.93, 2.013, 2.111, 2.213, 2.315,
         2.44},
        {2.253, 2.42, 2.594, 2.771, 2.956, 3.138, 3.31, 3.478, 3.651, 3.807, 3.956, 4.094, 4.211,
         4.324}}},
      {"TiN",
       {{1.965, 1.762, 1.565, 1.369, 1.204, 1.233, 1.262, 1.291, 1.32, 1.393, 1.465, 1.538, 1.611,
         1.707},
        {1.051, 1.041, 1.237, 1.459, 1.684, 1.936, 2.188, 2.439, 2.691, 2.853, 3.016, 3.178, 3.341,
         3.558}}},
      {"W",
       {{3.443, 3.36, 3.304, 3.328, 3.394, 3.48, 3.491, 3.539, 3.6, 3.692, 3.791, 3.849, 3.811,
         3.648},
        {2.513, 2.418, 2.483, 2.593, 2.688, 2.72, 2.746, 2.839, 2.89, 2.936, 2.917, 2.854, 2.751,
         2.69}}},
      {"a-C",
       {{2.04, 2.104, 2.164, 2.226, 2.275, 2.323, 2.374, 2.403, 2.43, 2.43, 2.43, 2.405, 2.371,
         2.326},
        {0.913, 0.901, 0.891, 0.882, 0.874, 0.856, 0.824, 0.787, 0.75, 0.728, 0.706, 0.702, 0.706,
         0.714}}}};
  return all;
}

}  // namespace

Rgb rgb_of(const Spectrum& spectrum, ColorOf of) {
  if (spectrum.samples.empty()) {
    return gray(static_cast<float>(spectrum.constant));
  }
  spectrum::Sampled known;
  for (const Spectrum::Sample& sample : spectrum.samples) {
    known.wavelengths.push_back(sample.nanometres);
    known.values.push_back(sample.value);
  }
  const spectrum::Sampled sampled = spectrum::zero_outside(known);
  return rounded(of == ColorOf::kLight ? spectrum::light_rgb(sampled)
                                       : spectrum::factor_rgb(sampled));
}

Rgb rgb_of(const BlackBody& body) {
  // Mitsuba's values are Planck's radiance in watts per square metre, steradian and nanometre.
  // The spectrum has its maximum `radiance` at the wavelength `peak`. `relative` is the colour of
  // the spectrum after a division by this maximum.
  const double kelvin = std::clamp(body.kelvin, 100.0, 1e5);
  const spectrum::Rgb3 relative = spectrum::light_rgb(spectrum::blackbody(kelvin));
  constexpr double kWien = 2.897771955e-3;          // Wien's displacement constant, m K
  constexpr double kFirst = 1.191042972397188e-16;  // 2 h c^2, W m^2
  // exp(x) - 1 at the peak, where x = h c / (wavelength k T) = 4.965114
  constexpr double kPeak = 142.32492;
  const double peak = kWien / kelvin;
  const double radiance = kFirst / (peak * peak * peak * peak * peak) / kPeak * 1e-9;
  const double scale = body.scale * radiance;
  return rounded({relative[0] * scale, relative[1] * scale, relative[2] * scale});
}

absl::StatusOr<Spectrum> sampled_spectrum(const Parameters& from) {
  ASSIGN_OR_RETURN(const std::string values, from.text("values", ""));
  const std::vector<std::string> numbers = parts_of(values);
  Spectrum spectrum;
  if (from.object().type == "irregular") {
    ASSIGN_OR_RETURN(const std::string wavelengths, from.text("wavelengths", ""));
    const std::vector<std::string> at = parts_of(wavelengths);
    if (at.size() != numbers.size() || at.size() < 2) {
      return error_at(from.place(), "a spectrum needs as many values as wavelengths, at least two");
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
      ASSIGN_OR_RETURN(const double nanometres, read_number(at[i]));
      ASSIGN_OR_RETURN(const double value, read_number(numbers[i]));
      if (const absl::Status added = add_sample(spectrum, nanometres, value); !added.ok()) {
        return at_place(from.place(), added);
      }
    }
    return spectrum;
  }
  ASSIGN_OR_RETURN(const double least, from.number("wavelength_min", 360));
  ASSIGN_OR_RETURN(const double most, from.number("wavelength_max", 830));
  if (numbers.size() < 2 || !(least < most)) {
    return error_at(
        from.place(),
        "a spectrum needs at least two values, and wavelength_min below wavelength_max");
  }
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    ASSIGN_OR_RETURN(const double value, read_number(numbers[i]));
    const double share = static_cast<double>(i) / static_cast<double>(numbers.size() - 1);
    spectrum.samples.push_back({least + (most - least) * share, value});
  }
  return spectrum;
}

absl::StatusOr<double> index_of_refraction(const Parameters& from, const std::string& name,
                                           const std::string& otherwise) {
  // Indices at 589 nm from Hecht, "Optics", 4th edition, as Mitsuba lists them.
  static const std::map<std::string, double> indices = {
      {"vacuum", 1},        {"helium", 1.000036},        {"hydrogen", 1.000132},
      {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.333},
      {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
      {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
      {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
      {"pyrex", 1.47},      {"acrylic glass", 1.49},     {"polypropylene", 1.49},
      {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
      {"pet", 1.575},       {"diamond", 2.419}};
  const Property* property = from.find(name);
  const auto* given = property != nullptr ? std::get_if<std::string>(&property->value) : nullptr;
  if (property != nullptr && given == nullptr) {
    ASSIGN_OR_RETURN(const double index, from.number(name, 1));
    if (!(index > 0)) {
      return error_at(property->place, absl::StrCat(name, " must be above 0"));
    }
    return index;
  }
  const std::string material = given != nullptr ? *given : otherwise;
  const auto found = indices.find(absl::AsciiStrToLower(material));
  if (found == indices.end()) {
    return error_at(property->place, absl::StrCat("no index of refraction is known for \"",
                                                  material, "\": write a number"));
  }
  return found->second;
}

absl::StatusOr<MetalIndex> metal_of(const std::string& name) {
  const auto found = metals().find(name);
  if (found == metals().end()) {
    return absl::NotFoundError(name);
  }
  // The illuminant has equal energy at all wavelengths, as in Mitsuba's reference images of metals.
  // It is not D65.
  const auto color = [](const std::array<double, 14>& values) {
    return rounded(spectrum::light_rgb({metal_wavelengths(), {values.begin(), values.end()}}));
  };
  return MetalIndex{color(found->second.eta), color(found->second.k)};
}

}  // namespace bandsaw::mitsuba
