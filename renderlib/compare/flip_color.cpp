// The colour pipeline of FLIP. Symbols, tables and equations are those of Andersson et al. 2020
// (compare/flip.h), section 4.1.

#include <array>
#include <cmath>

#include "renderlib/compare/flip_parts.h"
#include "renderlib/compare/perceived.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

// Contrast sensitivity of a channel as a sum of two Gaussians of the visual angle (table 1).
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kLuminance = {1, 0.0047, 0, 1e-5};
constexpr Sensitivity kRedGreen = {1, 0.0053, 0, 1e-5};
constexpr Sensitivity kBlueYellow = {34.1, 0.04, 13.5, 0.025};
constexpr double kWidest = 0.04;  // largest b of the three channels

constexpr double kColorExponent = 0.7;  // q_c
constexpr double kKneeError = 0.4;      // p_c
constexpr double kKneeResult = 0.95;    // p_t

// Returns three standard deviations of the widest Gaussian, in pixels, rounded up.
int kernel_radius(double pixels_per_degree) {
  return static_cast<int>(std::ceil(3 * std::sqrt(kWidest / (2 * kPi * kPi)) * pixels_per_degree));
}

// Returns the weights exp(-pi^2 d^2 / b), with d in degrees.
FilterWeights gaussian_of(double b, double pixels_per_degree, int radius) {
  return gaussian(std::sqrt(b / 2) / kPi * pixels_per_degree, radius);
}

// Filters by equation 3, with weights that sum to 1.
Plane blurred(const Plane& plane, const Sensitivity& s, double pixels_per_degree) {
  const int radius = kernel_radius(pixels_per_degree);
  const FilterWeights first = gaussian_of(s.b1, pixels_per_degree, radius);
  const double w1 = s.a1 * std::sqrt(kPi / s.b1);
  Plane out = filtered(plane, first, first);
  if (s.a2 == 0) {
    const double total = sum(first) * sum(first);
    for (double& value : out.values) {
      value /= total;
    }
    return out;
  }
  const FilterWeights second = gaussian_of(s.b2, pixels_per_degree, radius);
  const double w2 = s.a2 * std::sqrt(kPi / s.b2);
  const double total = w1 * sum(first) * sum(first) + w2 * sum(second) * sum(second);
  const Plane other = filtered(plane, second, second);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    out.values[i] = (w1 * out.values[i] + w2 * other.values[i]) / total;
  }
  return out;
}

using Opponents = std::array<Plane, 3>;

// Returns the image in the opponent space, blurred as the eye sees it.
Opponents seen(const Image& image, double pixels_per_degree) {
  Opponents planes;
  planes.fill(Plane(image.width, image.height));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Vec3 value = opponents(xyz_over_white(image.pixels[i]));
    planes[0].values[i] = value.x;
    planes[1].values[i] = value.y;
    planes[2].values[i] = value.z;
  }
  return {blurred(planes[0], kLuminance, pixels_per_degree),
          blurred(planes[1], kRedGreen, pixels_per_degree),
          blurred(planes[2], kBlueYellow, pixels_per_degree)};
}

// Section 4.1.2 (Hunt effect): dark colours appear less colourful.
Vec3 hunt(const Vec3& lab) { return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z}; }

// Returns the colour in L*a*b* with the Hunt effect.
Vec3 adjusted(const Rgb& linear) { return hunt(lab(xyz_over_white(linear))); }

// Returns the colour of pixel i, clamped to [0, 1] in linear RGB, in L*a*b* with the Hunt effect.
Vec3 adjusted(const Opponents& planes, std::size_t i) {
  const Vec3 linear =
      linear_of(xyz_of_opponents({planes[0].values[i], planes[1].values[i], planes[2].values[i]}));
  return adjusted(clamped(Rgb{static_cast<float>(linear.x), static_cast<float>(linear.y),
                              static_cast<float>(linear.z)}));
}

// Returns the distance of equation 7 (Abasi et al. 2020), raised to the power of equation 8.
double distance(const Vec3& a, const Vec3& b) {
  const double hyab =
      std::abs(a.x - b.x) + std::sqrt((a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
  return pow(hyab, kColorExponent);
}

// Maps an error in [0, largest] to [0, 1] by equation 9. Errors below the share kKneeError of
// `largest` get the range from 0 to kKneeResult.
double redistributed(double error, double largest) {
  const double knee = kKneeError * largest;
  return error < knee ? kKneeResult / knee * error
                      : kKneeResult + (error - knee) / (largest - knee) * (1 - kKneeResult);
}

}  // namespace

Plane flip_color(const Image& image, const Image& reference, double pixels_per_degree) {
  const double largest = distance(adjusted(Rgb{0, 1, 0}), adjusted(Rgb{0, 0, 1}));
  const Opponents a = seen(image, pixels_per_degree);
  const Opponents b = seen(reference, pixels_per_degree);
  Plane out(image.width, image.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    out.values[i] = redistributed(distance(adjusted(a, i), adjusted(b, i)), largest);
  }
  return out;
}

}  // namespace bandsaw
