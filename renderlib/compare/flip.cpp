// FLIP combines a colour difference and a feature difference (flip_parts.h) for each pixel.
// HDR-FLIP is the maximum of FLIP over several exposures.

#include "renderlib/compare/flip.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderlib/compare/flip_parts.h"
#include "renderlib/compare/perceived.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

// Film curve (k0 x^2 + k1 x) / (k3 x^2 + k4 x + k5) of Narkowicz 2016, with exposure 0.6.
constexpr double k0 = 0.6 * 0.6 * 2.51;
constexpr double k1 = 0.6 * 0.03;
constexpr double k3 = 0.6 * 0.6 * 2.43;
constexpr double k4 = 0.6 * 0.59;
constexpr double k5 = 0.14;

// Returns the film curve. `light` is clamped where the curve is white, because large values would
// give infinity over infinity.
float filmed(double light) {
  const double x = std::min(light, 1e6);
  return static_cast<float>(
      std::clamp((k0 * x * x + k1 * x) / (k3 * x * x + k4 * x + k5), 0.0, 1.0));
}

// Returns the radiance that the curve maps to 0.85.
double nearly_white() {
  constexpr double kShown = 0.85;
  const double a = k0 - kShown * k3;
  const double b = k1 - kShown * k4;
  const double c = -kShown * k5;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

// Returns the image as a screen shows it: radiance times `factor`, through the film curve.
Image exposed(const Image& image, double factor) {
  Image out = image;
  for (Rgb& pixel : out.pixels) {
    pixel = {filmed(std::max(0.0, pixel.r * factor)), filmed(std::max(0.0, pixel.g * factor)),
             filmed(std::max(0.0, pixel.b * factor))};
  }
  return out;
}

// A geometric series of factors of the radiance: first, first * step, first * step^2, ...
struct Exposures {
  double first = 1;
  double step = 1;
  int count = 1;
};

double log2_of(double x) { return log(x) / log(2.0); }

// Returns the exposures by equations 2 and 3 of Andersson et al. 2021 (flip.h). If the reference's
// median is black, only the exposure of its maximum is used.
Exposures exposures_of(const Image& reference) {
  std::vector<double> light;
  for (const Rgb& pixel : reference.pixels) {
    if (const double y = luminance(pixel); std::isfinite(y)) {
      light.push_back(y);
    }
  }
  if (light.empty()) {
    return {};
  }
  std::sort(light.begin(), light.end());
  const double most = light.back();
  const double middle = light[light.size() / 2];
  if (most <= 0) {
    return {};
  }
  const double start = log2_of(nearly_white() / most);
  const double stop = middle > 0 ? log2_of(nearly_white() / middle) : start;
  const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
  return {pow(2, start), pow(2, (stop - start) / (count - 1)), count};
}

}  // namespace

Plane flip(const Image& image, const Image& reference, double pixels_per_degree) {
  Image a = image;
  Image b = reference;
  std::transform(a.pixels.begin(), a.pixels.end(), a.pixels.begin(),
                 [](const Rgb& pixel) { return clamped(pixel); });
  std::transform(b.pixels.begin(), b.pixels.end(), b.pixels.begin(),
                 [](const Rgb& pixel) { return clamped(pixel); });
  Plane out = flip_color(a, b, pixels_per_degree);
  const Plane features = flip_features(a, b, pixels_per_degree);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    // Equation 13 of Andersson et al. 2020.
    out.values[i] = pow(out.values[i], 1 - features.values[i]);
  }
  return out;
}

Plane hdr_flip(const Image& image, const Image& reference, double pixels_per_degree) {
  const Exposures exposures = exposures_of(reference);
  Plane out(image.width, image.height);
  double factor = exposures.first;
  for (int i = 0; i < exposures.count; ++i) {
    const Plane at = flip(exposed(image, factor), exposed(reference, factor), pixels_per_degree);
    std::transform(at.values.begin(), at.values.end(), out.values.begin(), out.values.begin(),
                   [](double a, double b) { return std::max(a, b); });
    factor *= exposures.step;
  }
  return out;
}

bool beyond_screen(const Image& image) {
  return std::any_of(image.pixels.begin(), image.pixels.end(),
                     [](const Rgb& pixel) { return max_component(pixel) > 1; });
}

}  // namespace bandsaw
