// Smooths maps: by a box filter, and by weights that fall with differences of the guides (albedo,
// normal and depth).

#include "renderlib/denoise/maps.h"

#include <algorithm>
#include <array>

namespace bandsaw {
namespace {

// For each guide, the difference that counts as a distance of 1. The difference of the depth is
// relative to the depth.
constexpr float kAlbedoReach = 0.3f;
constexpr float kNormalReach = 0.2f;
constexpr float kDepthReach = 0.1f;
/// Other surfaces count this much as well. So a pixel at an edge, whose guides resemble no other
/// pixel's, is smoothed too.
constexpr float kLeastSimilarity = 0.1f;

using Guide = std::array<float, kGuides>;

Guide guide_at(const FitInput& input, int x, int y) {
  Guide guide;
  for (std::size_t g = 0; g < kGuides; ++g) {
    guide[g] = input.guides[g].at(x, y);
  }
  return guide;
}

/// Returns how similar the guides of two pixels are, in [kLeastSimilarity, 1]; 1 for equal guides.
/// In the mean for a pixel with the guides `a`, the weight of a pixel with the guides `b` has this
/// factor.
float similarity(const Guide& a, const Guide& b) {
  float distance = 0;
  for (std::size_t g = 0; g < kGuides; ++g) {
    const float reach = g < kFirstNormal  ? kAlbedoReach
                        : g < kDepthGuide ? kNormalReach
                                          : kDepthReach * std::max(a[kDepthGuide], 1e-6f);
    const float difference = (a[g] - b[g]) / reach;
    distance += difference * difference;
  }
  const float t = std::max(0.0f, 1 - distance / 4);
  return std::max(kLeastSimilarity, t * t * t * t);
}

}  // namespace

void smooth(Map& map, const MapSize& size, int radius, Pool& pool) {
  Map rows(map.size());
  pool.parallel_for(size.height, [&](std::int64_t y) {
    const std::size_t row = size.index(0, static_cast<int>(y));
    for (int x = 0; x < size.width; ++x) {
      const int first = std::max(0, x - radius);
      const int last = std::min(size.width - 1, x + radius);
      float sum = 0;
      for (int k = first; k <= last; ++k) {
        sum += map[row + static_cast<std::size_t>(k)];
      }
      rows[row + static_cast<std::size_t>(x)] = sum / static_cast<float>(last - first + 1);
    }
  });
  pool.parallel_for(size.height, [&](std::int64_t y) {
    const int first = std::max(0, static_cast<int>(y) - radius);
    const int last = std::min(size.height - 1, static_cast<int>(y) + radius);
    for (int x = 0; x < size.width; ++x) {
      float sum = 0;
      for (int k = first; k <= last; ++k) {
        sum += rows[size.index(x, k)];
      }
      map[size.index(x, static_cast<int>(y))] = sum / static_cast<float>(last - first + 1);
    }
  });
}

SurfaceSmoothing::SurfaceSmoothing(const FitInput& input, Pool& pool)
    : size_{input.width, input.wanted.count()}, weights_(size_.pixels() * kSide * kSide) {
  pool.parallel_for(size_.height, [&](std::int64_t row) {
    const int y = input.wanted.first + static_cast<int>(row);
    for (int x = 0; x < size_.width; ++x) {
      const Guide centre = guide_at(input, x, y);
      float* const to = &weights_[size_.index(x, static_cast<int>(row)) * kSide * kSide];
      float sum = 0;
      for (int i = 0; i < kSide * kSide; ++i) {
        const int dx = i % kSide - kRadius;
        const int dy = i / kSide - kRadius;
        // `inside` is 1 for the centre and for usable pixels of wanted rows, otherwise 0.
        const bool wanted = y + dy >= input.wanted.first && y + dy < input.wanted.last;
        const float inside = dx == 0 && dy == 0 ? 1.0f
                             : wanted           ? input.valid.at(x + dx, y + dy)
                                                : 0.0f;
        const float near =
            1 - static_cast<float>(dx * dx + dy * dy) / (2 * (kRadius + 1) * (kRadius + 1));
        to[i] = inside * near * similarity(centre, guide_at(input, x + dx, y + dy));
        sum += to[i];
      }
      for (int i = 0; i < kSide * kSide; ++i) {
        to[i] /= sum;
      }
    }
  });
}

void SurfaceSmoothing::apply(Map& map, Pool& pool) const {
  const Map from = map;
  pool.parallel_for(size_.height, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size_.width; ++x) {
      const float* const weights = &weights_[size_.index(x, y) * kSide * kSide];
      float sum = 0;
      for (int i = 0; i < kSide * kSide; ++i) {
        if (weights[i] > 0) {
          sum += weights[i] * from[size_.index(x + i % kSide - kRadius, y + i / kSide - kRadius)];
        }
      }
      map[size_.index(x, y)] = sum;
    }
  });
}

}  // namespace bandsaw
