// Computes SSIM as in Wang et al. 2004 (ssim.h), on grey values, with Gaussian windows.

#include "renderlib/compare/ssim.h"

#include <algorithm>

#include "renderlib/compare/perceived.h"
#include "renderlib/compare/plane.h"
#include "renderlib/image/srgb.h"

namespace bandsaw {
namespace {

// The constants of section III.B, equations 13 and 14, with L = 1, the range of the values.
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

// Returns the sRGB-coded luminance of each pixel, in [0, 1].
Plane gray_of(const Image& image) {
  Plane gray(image.width, image.height);
  std::transform(image.pixels.begin(), image.pixels.end(), gray.values.begin(),
                 [](const Rgb& pixel) { return srgb_curve(luminance(clamped(pixel))); });
  return gray;
}

Plane product(const Plane& a, const Plane& b) {
  Plane out(a.width, a.height);
  std::transform(a.values.begin(), a.values.end(), b.values.begin(), out.values.begin(),
                 [](double x, double y) { return x * y; });
  return out;
}

}  // namespace

double ssim(const Image& image, const Image& reference) {
  FilterWeights window = gaussian(1.5, 5);
  const double total = sum(window);
  for (double& weight : window) {
    weight /= total;
  }
  const auto blurred = [&](const Plane& plane) { return filtered(plane, window, window); };
  const Plane a = gray_of(image);
  const Plane b = gray_of(reference);
  const Plane mean_a = blurred(a);
  const Plane mean_b = blurred(b);
  const Plane aa = blurred(product(a, a));
  const Plane bb = blurred(product(b, b));
  const Plane ab = blurred(product(a, b));
  Plane out(a.width, a.height);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    const double ma = mean_a.values[i];
    const double mb = mean_b.values[i];
    const double variances = aa.values[i] - ma * ma + bb.values[i] - mb * mb;
    const double covariance = ab.values[i] - ma * mb;
    out.values[i] = (2 * ma * mb + kC1) * (2 * covariance + kC2) /
                    ((ma * ma + mb * mb + kC1) * (variances + kC2));
  }
  return mean(out);
}

}  // namespace bandsaw
