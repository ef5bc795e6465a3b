// The feature pipeline of FLIP: differences of edges and points. Symbols and equations are those of
// Andersson et al. 2020 (compare/flip.h), section 4.2.

#include <algorithm>
#include <cmath>

#include "renderlib/compare/flip_parts.h"
#include "renderlib/compare/perceived.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

constexpr double kFeatureWidth = 0.082;   // w, in degrees
constexpr double kFeatureExponent = 0.5;  // q_f

struct Features {
  Plane edges;
  Plane points;
};

// Scales the positive weights to the sum 1 and the negative ones to the sum -1, so that a feature's
// strength is in units of contrast. `across` is the sum of the weights along the other axis. These
// weights are not normalised, so the result is divided by `across`.
FilterWeights balanced(FilterWeights kernel, double across) {
  double above = 0;
  double below = 0;
  for (const double weight : kernel) {
    (weight > 0 ? above : below) += weight;
  }
  for (double& weight : kernel) {
    weight /= (weight > 0 ? above : -below) * across;
  }
  return kernel;
}

// Returns the luminance of each pixel, relative to white.
Plane gray_of(const Image& image) {
  Plane gray(image.width, image.height);
  std::transform(image.pixels.begin(), image.pixels.end(), gray.values.begin(),
                 [](const Rgb& pixel) { return xyz_over_white(pixel).y; });
  return gray;
}

// Returns the length of the vector (x, y) for each pixel.
Plane length(const Plane& x, const Plane& y) {
  Plane out(x.width, x.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    out.values[i] = std::sqrt(x.values[i] * x.values[i] + y.values[i] * y.values[i]);
  }
  return out;
}

// Filters by the first and second derivatives of a Gaussian (equations 10 and 11).
Features features_of(const Image& image, double pixels_per_degree) {
  const double deviation = 0.5 * kFeatureWidth * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const FilterWeights across = gaussian(deviation, radius);
  FilterWeights edge = across;
  FilterWeights point = across;
  for (int x = -radius; x <= radius; ++x) {
    const auto i = static_cast<std::size_t>(x + radius);
    edge[i] *= -x;
    point[i] *= x * x / (deviation * deviation) - 1;
  }
  edge = balanced(edge, sum(across));
  point = balanced(point, sum(across));
  const Plane gray = gray_of(image);
  return {length(filtered(gray, edge, across), filtered(gray, across, edge)),
          length(filtered(gray, point, across), filtered(gray, across, point))};
}

}  // namespace

Plane flip_features(const Image& image, const Image& reference, double pixels_per_degree) {
  const Features a = features_of(image, pixels_per_degree);
  const Features b = features_of(reference, pixels_per_degree);
  Plane out(image.width, image.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    const double edges = std::abs(a.edges.values[i] - b.edges.values[i]);
    const double points = std::abs(a.points.values[i] - b.points.values[i]);
    out.values[i] = pow(std::min(std::max(edges, points) / std::sqrt(2.0), 1.0), kFeatureExponent);
  }
  return out;
}

}  // namespace bandsaw
