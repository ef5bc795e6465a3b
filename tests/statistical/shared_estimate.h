#pragma once

// What radiance_along (estimate.h) is for one ray, for rays whose pixels share their paths.

#include <array>
#include <vector>

#include "renderlib/integrate/shared_paths.h"
#include "tests/support/statistics.h"

namespace bandsaw::test {

/// Green channel of each ray, seeds [0, seeds), samples [0, samples) of each; `samples` a power of
/// two.
inline std::array<Moments, kMaxShared> shared_radiance_along(
    const Scene& scene, const std::array<Ray, kMaxShared>& camera_rays, const PathOptions& options,
    std::uint64_t samples, std::uint64_t seeds = 32) {
  std::array<Moments, kMaxShared> means;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    std::vector<SharedPixel> pixels;
    for (const Ray& ray : camera_rays) {
      const auto x = static_cast<std::uint32_t>(pixels.size());
      pixels.push_back({.sampler = PixelSampler(seed, x, 7), .camera_ray = ray});
    }
    std::array<double, kMaxShared> sums{};
    PathCounts counts;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
      shared_radiance(scene, absl::MakeSpan(pixels), sample, options, counts);
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        sums[i] += pixels[i].radiance.g;
      }
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      means[i].add(sums[i] / static_cast<double>(samples));
    }
  }
  return means;
}

}  // namespace bandsaw::test
