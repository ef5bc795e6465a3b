// Named spectra. Measured indices of refraction are facts of the cited papers, at the wavelengths
// where a line between them is within a hundredth of the curve, as far as the papers go.

#include <array>
#include <cmath>

#include "absl/strings/match.h"
#include "absl/strings/strip.h"
#include "renderlib/import/spectrum/observer.h"
#include "renderlib/import/spectrum/spectrum.h"

namespace bandsaw::spectrum {
namespace {

struct Index {
  double nm;
  double eta;
  double k;
};

// Johnson and Christy, Physical Review B 6 (1972).
constexpr std::array kCopper = {
    Index{397.4, 1.32, 2.116}, Index{413.3, 1.28, 2.207}, Index{430.5, 1.25, 2.305},
    Index{450.9, 1.24, 2.397}, Index{471.4, 1.25, 2.483}, Index{495.9, 1.22, 2.564},
    Index{520.9, 1.18, 2.608}, Index{548.6, 1.02, 2.577}, Index{579.4, 0.70, 2.704},
    Index{616.8, 0.30, 3.205}, Index{659.5, 0.22, 3.747}, Index{704.5, 0.21, 4.205},
    Index{756.0, 0.24, 4.665}};
constexpr std::array kGold = {
    Index{397.4, 1.47, 1.952}, Index{413.3, 1.46, 1.958}, Index{430.5, 1.45, 1.948},
    Index{450.9, 1.38, 1.914}, Index{471.4, 1.31, 1.849}, Index{495.9, 1.04, 1.833},
    Index{520.9, 0.62, 2.081}, Index{548.6, 0.43, 2.455}, Index{579.4, 0.29, 2.863},
    Index{616.8, 0.21, 3.272}, Index{659.5, 0.14, 3.697}, Index{704.5, 0.13, 4.103},
    Index{756.0, 0.14, 4.542}};
// Lynch and Hunter in Palik, Handbook of Optical Constants of Solids (1985).
constexpr std::array kSilver = {
    Index{400, 0.173, 1.95}, Index{450, 0.151, 2.47}, Index{496, 0.130, 2.88},
    Index{540, 0.129, 3.25}, Index{564, 0.120, 3.45}, Index{620, 0.131, 3.88},
    Index{653, 0.140, 4.15}, Index{689, 0.140, 4.44}, Index{729, 0.148, 4.74}};
// Smith, Shiles and Inokuti in the same book.
constexpr std::array kAluminium = {Index{400, 0.490, 4.86}, Index{450, 0.618, 5.47},
                                   Index{500, 0.769, 6.08}, Index{550, 0.958, 6.69},
                                   Index{600, 1.200, 7.26}, Index{650, 1.470, 7.79},
                                   Index{700, 1.830, 8.31}};
// Brass of 70 % copper: Querry, report CRDC-CR-85034 (1985).
constexpr std::array kBrass = {Index{400, 1.445, 1.805}, Index{450, 1.430, 1.830},
                               Index{500, 1.140, 2.030}, Index{550, 0.770, 2.360},
                               Index{600, 0.527, 2.830}, Index{650, 0.445, 3.270},
                               Index{700, 0.446, 3.780}};
// Stephens and Malitson, Journal of Research of the NBS 49 (1952).
constexpr std::array kMagnesia = {Index{400, 1.761, 0}, Index{486, 1.746, 0}, Index{589, 1.737, 0},
                                  Index{656, 1.733, 0}, Index{700, 1.731, 0}};
// Rutile, ordinary ray: DeVore, Journal of the Optical Society of America 41 (1951).
constexpr std::array kTitania = {Index{430, 2.871, 0}, Index{460, 2.785, 0}, Index{500, 2.710, 0},
                                 Index{550, 2.648, 0}, Index{600, 2.605, 0}, Index{656, 2.576, 0},
                                 Index{700, 2.555, 0}};

template <class Table>
Sampled column(const Table& table, bool is_eta) {
  Sampled out;
  for (const Index& index : table) {
    out.wavelengths.push_back(index.nm);
    out.values.push_back(is_eta ? index.eta : index.k);
  }
  return out;
}

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

/// Coefficients of Sellmeier's formula, for wavelengths in micrometres (catalogue of Schott).
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

std::optional<Sampled> glass(absl::string_view name) {
  for (const Glass& glass : kGlasses) {
    if (name != glass.name) {
      continue;
    }
    Sampled out;
    for (int nm = kFirstNm; nm <= kLastNm; nm += 10) {
      const double square = nm * nm * 1e-6;
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
      return metal(name, true);
    }
    return absl::ConsumeSuffix(&name, "-k") ? metal(name, false) : std::nullopt;
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
