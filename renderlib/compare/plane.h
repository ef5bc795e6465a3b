#pragma once

// Single-channel images and their filters, for FLIP and SSIM.

#include <cstdint>
#include <vector>

#include "renderlib/image/image.h"

namespace bandsaw {

/// An image with one number for each pixel.
struct Plane {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<double> values;  ///< width x height, rows from the top

  Plane() = default;
  Plane(std::uint32_t w, std::uint32_t h)
      : width(w), height(h), values(static_cast<std::size_t>(w) * h) {}
};

/// Returns the mean of all values; the plane MUST NOT be empty.
double mean(const Plane& plane);

/// A filter kernel: weights for offsets -radius to radius.
using FilterWeights = std::vector<double>;

/// Returns exp(-(x / deviation)^2 / 2) for |x| <= radius, not normalised.
FilterWeights gaussian(double deviation, int radius);

double sum(const FilterWeights& kernel);

/// Filters the plane by one kernel along x and another along y; beyond the edges the outermost
/// value is repeated. Kernels have an odd size.
Plane filtered(const Plane& plane, const FilterWeights& along_x, const FilterWeights& along_y);

}  // namespace bandsaw
