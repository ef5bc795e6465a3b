// Named spectra: indices of refraction of metals and glasses, and illuminants. The tables hold
// measured values of the cited papers. A wavelength is left out if linear interpolation between the
// remaining wavelengths differs from the paper's curve by at most a hundredth.

#include <array>
#include <cmath>

#include "absl/strings/match.h"
#include "absl/strings/strip.h"
#include "renderlib/import/spectrum/observer.h"
#include "renderlib/import/spectrum/spectrum.h"

namespace bandsaw::spectrum {
namespace {

/// Complex index of refraction, eta + i k, at a wavelength.
struct Index {
  double nm;
  double eta;
  double k;
};

// Palik (ed.), "Handbook of Optical Constants of Solids" (1985): copper, silver and gold by Lynch
// and Hunter, aluminium by Smith, Shiles and Inokuti. pbrt's spectra of these names are the same
// data.
constexpr std::array kCopper = {
    Index{387.5, 1.180, 2.210}, Index{400.0, 1.175, 2.130}, Index{413.3, 1.180, 2.210},
    Index{427.5, 1.175, 2.289}, Index{442.8, 1.170, 2.362}, Index{459.2, 1.160, 2.433},
    Index{476.9, 1.150, 2.504}, Index{495.9, 1.135, 2.564}, Index{516.6, 1.120, 2.605},
    Index{539.1, 1.040, 2.583}, Index{563.6, 0.826, 2.599}, Index{590.4, 0.468, 2.809},
    Index{619.9, 0.272, 3.240}, Index{652.6, 0.214, 3.670}, Index{688.8, 0.213, 4.050},
    Index{729.3, 0.223, 4.430}, Index{774.9, 0.250, 4.817}};
constexpr std::array kGold = {
    Index{387.5, 1.674, 1.936}, Index{400.0, 1.658, 1.956}, Index{413.3, 1.636, 1.958},
    Index{427.5, 1.616, 1.940}, Index{442.8, 1.562, 1.904}, Index{459.2, 1.426, 1.846},
    Index{476.9, 1.242, 1.796}, Index{495.9, 0.916, 1.840}, Index{516.6, 0.608, 2.120},
    Index{539.1, 0.402, 2.540}, Index{563.6, 0.306, 2.880}, Index{590.4, 0.236, 2.970},
    Index{619.9, 0.194, 3.060}, Index{652.6, 0.166, 3.150}, Index{688.8, 0.160, 3.800},
    Index{729.3, 0.164, 4.357}, Index{774.9, 0.176, 4.860}};
constexpr std::array kSilver = {
    Index{381.5, 0.198, 1.735}, Index{400.0, 0.173, 1.950}, Index{427.5, 0.160, 2.260},
    Index{459.2, 0.144, 2.560}, Index{495.9, 0.130, 2.880}, Index{539.1, 0.129, 3.250},
    Index{563.6, 0.120, 3.450}, Index{590.4, 0.121, 3.660}, Index{619.9, 0.131, 3.880},
    Index{652.6, 0.140, 4.150}, Index{688.8, 0.140, 4.440}, Index{729.3, 0.148, 4.740},
    Index{774.9, 0.143, 5.090}};
constexpr std::array kAluminium = {
    Index{387.5, 0.460, 4.710}, Index{427.5, 0.558, 5.200}, Index{459.2, 0.644, 5.580},
    Index{495.9, 0.755, 6.030}, Index{539.1, 0.912, 6.550}, Index{590.4, 1.150, 7.150},
    Index{619.9, 1.300, 7.480}, Index{652.6, 1.490, 7.820}, Index{688.8, 1.740, 8.210},
    Index{729.3, 2.140, 8.570}, Index{751.4, 2.410, 8.620}, Index{774.9, 2.630, 8.600}};
// Brass of 70 % copper: Querry, report CRDC-CR-85034 (1985), taken from refractiveindex.info.
constexpr std::array kBrass = {
    Index{380, 1.487, 1.818}, Index{400, 1.445, 1.805}, Index{410, 1.405, 1.794},
    Index{420, 1.350, 1.786}, Index{430, 1.278, 1.784}, Index{440, 1.191, 1.797},
    Index{450, 1.094, 1.829}, Index{460, 0.994, 1.883}, Index{470, 0.900, 1.957},
    Index{480, 0.816, 2.046}, Index{490, 0.745, 2.145}, Index{500, 0.686, 2.250},
    Index{520, 0.602, 2.464}, Index{540, 0.549, 2.668}, Index{560, 0.505, 2.860},
    Index{580, 0.468, 3.059}, Index{600, 0.450, 3.253}, Index{620, 0.449, 3.434},
    Index{640, 0.444, 3.609}, Index{660, 0.445, 3.778}, Index{700, 0.446, 4.106},
    Index{740, 0.455, 4.424}, Index{780, 0.464, 4.737}};
// Stephens and Malitson, Journal of Research of the NBS 49 (1952).
constexpr std::array kMagnesia = {
    Index{382, 1.7668, 0},   Index{404.6, 1.7610, 0}, Index{435.8, 1.7547, 0},
    Index{486.0, 1.7471, 0}, Index{546.2, 1.7408, 0}, Index{589.3, 1.7374, 0},
    Index{656.3, 1.7334, 0}, Index{706.4, 1.7310, 0}, Index{767.7, 1.7287, 0}};
// Rutile, extraordinary ray, as pbrt has it: n^2 = 7.197 + 0.3322 / (L^2 - 0.0843), L in
// micrometres (DeVore, Journal of the Optical Society of America 41 (1951)).
constexpr std::array kTitania = {Index{400, 3.404, 0}, Index{410, 3.341, 0}, Index{420, 3.287, 0},
                                 Index{430, 3.240, 0}, Index{440, 3.199, 0}, Index{460, 3.132, 0},
                                 Index{480, 3.077, 0}, Index{500, 3.033, 0}, Index{520, 2.997, 0},
                                 Index{540, 2.966, 0}, Index{560, 2.940, 0}, Index{580, 2.918, 0},
                                 Index{600, 2.899, 0}, Index{640, 2.867, 0}, Index{680, 2.842, 0},
                                 Index{720, 2.822, 0}, Index{780, 2.798, 0}};

/// Returns the column eta or k of a table as a spectrum.
template <class Table>
Sampled column(const Table& table, bool is_eta) {
  Sampled out;
  for (const Index& index : table) {
    out.wavelengths.push_back(index.nm);
    out.values.push_back(is_eta ? index.eta : index.k);
  }
  return out;
}

/// Returns eta or k of the material `name`; std::nullopt if there is no such table.
std::optional<Sampled> metal(absl::string_view name, bool is_eta) {
  return name == "Cu"     ? std::optional(column(kCopper, is_eta))
         : name == "Au"   ? std::optional(column(kGold, is_eta))
         : name == "Ag"   ? std::optional(column(kSilver, is_eta))
         : name == "Al"   ? std::optional(column(kAluminium, is_eta))
         : name == "CuZn" ? std::optional(column(kBrass, is_eta))
         : name == "MgO"  ? std::optional(column(kMagnesia, is_eta))
         : name == "TiO2" ? std::optional(column(kTitania, is_eta))
                          : std::nullopt;
}

/// Coefficients of Sellmeier's formula, n^2 = 1 + sum of b L^2 / (L^2 - c), for wavelengths L in
/// micrometres (catalogue of Schott).
struct Glass {
  const char* name;
  double b[3];
  double c[3];
};
constexpr Glass kGlasses[] = {
    {"BK7", {1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}},
    {"BAF10", {1.5851495, 0.143559385, 1.08521269}, {0.00926681282, 0.0424489805, 105.613573}},
    {"FK51A", {0.971247817, 0.216901417, 0.904651666}, {0.00472301995, 0.0153575612, 168.68133}},
    {"LASF9", {2.00029547, 0.298926886, 1.80691843}, {0.0121426017, 0.0538736236, 156.530829}},
    {"F5", {1.52481889, 0.187085527, 1.42729015}, {0.011254756, 0.0588995392, 129.141675}},
    {"F10", {1.62153902, 0.256287842, 1.64447552}, {0.0122241457, 0.0595736775, 147.468793}},
    {"F11", {1.73759695, 0.313747346, 1.89878101}, {0.013188707, 0.0623068142, 155.23629}}};

/// Returns the index of refraction of the glass `name` by Sellmeier's formula. Returns std::nullopt
/// if there is no such glass.
std::optional<Sampled> glass(absl::string_view name) {
  for (const Glass& glass : kGlasses) {
    if (name != glass.name) {
      continue;
    }
    Sampled out;
    for (int nm = kFirstNm; nm <= kLastNm; nm += 10) {
      const double square = nm * nm * 1e-6;  // of the wavelength in micrometres
      double sum = 1;
      for (std::size_t i = 0; i < 3; ++i) {
        sum += glass.b[i] * square / (square - glass.c[i]);
      }
      out.wavelengths.push_back(nm);
      out.values.push_back(std::sqrt(sum));
    }
    return out;
  }
  return std::nullopt;
}

Sampled d65() {
  Sampled out;
  for (int nm = kFirstNm; nm <= kLastNm; nm += 10) {
    out.wavelengths.push_back(nm);
    out.values.push_back(daylight(nm));
  }
  return out;
}

}  // namespace

std::optional<Sampled> named(absl::string_view name) {
  if (absl::ConsumePrefix(&name, "metal-")) {
    if (absl::ConsumeSuffix(&name, "-eta")) {
      return metal(name, /*is_eta=*/true);
    }
    return absl::ConsumeSuffix(&name, "-k") ? metal(name, /*is_eta=*/false) : std::nullopt;
  }
  if (absl::ConsumePrefix(&name, "glass-")) {
    return glass(name);
  }
  constexpr double kIlluminantA = 2856;  // kelvin
  return name == "stdillum-D65" ? std::optional(d65())
         : name == "stdillum-A" ? std::optional(blackbody(kIlluminantA))
                                : std::nullopt;
}

}  // namespace bandsaw::spectrum
