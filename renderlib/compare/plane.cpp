// Filters are separable: rows are filtered first, then columns. Beyond the border the outermost
// value is repeated.

#include "renderlib/compare/plane.h"

#include <algorithm>
#include <numeric>

#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

int radius_of(const FilterWeights& kernel) { return static_cast<int>(kernel.size() / 2); }

// Filters `count` values with a stride of `step`.
void filter_line(const double* from, double* to, int count, int step, const FilterWeights& kernel) {
  const int radius = radius_of(kernel);
  for (int i = 0; i < count; ++i) {
    double total = 0;
    for (int k = -radius; k <= radius; ++k) {
      const int at = std::clamp(i + k, 0, count - 1);
      total += kernel[static_cast<std::size_t>(k + radius)] *
               from[static_cast<std::ptrdiff_t>(at) * step];
    }
    to[static_cast<std::ptrdiff_t>(i) * step] = total;
  }
}

}  // namespace

FilterWeights gaussian(double deviation, int radius) {
  FilterWeights kernel;
  for (int x = -radius; x <= radius; ++x) {
    const double far = x / deviation;
    kernel.push_back(exp(-0.5 * far * far));
  }
  return kernel;
}

double mean(const Plane& plane) {
  return sum(plane.values) / static_cast<double>(plane.values.size());
}

double sum(const FilterWeights& kernel) {
  return std::accumulate(kernel.begin(), kernel.end(), 0.0);
}

Plane filtered(const Plane& plane, const FilterWeights& along_x, const FilterWeights& along_y) {
  const auto width = static_cast<int>(plane.width);
  const auto height = static_cast<int>(plane.height);
  Plane rows(plane.width, plane.height);
  for (int y = 0; y < height; ++y) {
    const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(y) * width;
    filter_line(plane.values.data() + start, rows.values.data() + start, width, 1, along_x);
  }
  Plane out(plane.width, plane.height);
  for (int x = 0; x < width; ++x) {
    filter_line(rows.values.data() + x, out.values.data() + x, height, width, along_y);
  }
  return out;
}

}  // namespace bandsaw
