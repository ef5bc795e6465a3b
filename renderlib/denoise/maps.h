#pragma once

// Maps: one float for each pixel of an image, and how they are smoothed.

#include <cstddef>
#include <vector>

#include "renderlib/base/pool.h"
#include "renderlib/denoise/fit.h"

namespace bandsaw {

using Map = std::vector<float>;

struct MapSize {
  int width = 0;
  int height = 0;
  std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Replaces each value by the mean of the values up to `radius` pixels away in x and y, inside the
/// image.
void smooth(Map& map, const MapSize& size, int radius, Pool& pool);

/// Smooths maps whose rows are the wanted rows of an image (FitInput::wanted). Each value becomes a
/// weighted mean of the values up to two pixels away in x and y. The weights fall with the distance
/// and with the difference of the guides (albedo, normal and depth), so that pixels of other
/// surfaces count little. Other rows count as outside of the image.
class SurfaceSmoothing {
 public:
  static constexpr int kRadius = 2;
  static constexpr int kSide = 2 * kRadius + 1;

  SurfaceSmoothing(const FitInput& input, Pool& pool);
  void apply(Map& map, Pool& pool) const;

 private:
  MapSize size_;
  std::vector<float> weights_;  ///< kSide^2 for each pixel; their sum is 1
};

}  // namespace bandsaw
