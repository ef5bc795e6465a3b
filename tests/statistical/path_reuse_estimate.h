#pragma once

// Estimates the mean radiance along the rays of pixels that share the second vertices of their
// paths (path reuse, renderlib/integrate/path_reuse.h), with standard errors. The mean over the
// samples of one seed is one observation, and the standard error is computed from the observations
// of many seeds.

#include <array>
#include <vector>

#include "renderlib/integrate/path_reuse.h"
#include "tests/support/statistics.h"

namespace bandsaw::test {

/// Returns, for each ray, the moments of the green channel over the seeds [0, seeds). Each seed
/// adds one number, the mean over the samples [0, samples). `samples` is a power of two.
inline std::array<Moments, kMaxReusePixels> radiance_with_reuse_along(
    const Scene& scene, const std::array<Ray, kMaxReusePixels>& camera_rays,
    const PathOptions& options, std::uint64_t samples, std::uint64_t seeds = 32) {
  std::array<Moments, kMaxReusePixels> means;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    std::vector<ReusePixel> pixels;
    for (const Ray& ray : camera_rays) {
      const auto x = static_cast<std::uint32_t>(pixels.size());
      pixels.push_back({.sampler = PixelSampler(seed, x, 7), .camera_ray = ray});
    }
    std::array<double, kMaxReusePixels> sums{};
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
      radiance_with_reuse(scene, absl::MakeSpan(pixels), sample, options);
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
