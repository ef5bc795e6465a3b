#pragma once

// Estimates the mean radiance along one ray with its standard error, for the tests of this folder.
// The Owen-scrambled samples of one seed are correlated, so the mean over the samples of one seed
// is one observation. The standard error is computed from the observations of many seeds.

#include "renderlib/integrate/path.h"
#include "tests/support/statistics.h"

namespace bandsaw::test {

/// Returns the moments of the green channel over the seeds [0, seeds). Each seed adds one number,
/// the mean over the samples [0, samples). `samples` is a power of two.
inline Moments radiance_along(const Scene& scene, const Ray& ray, const PathOptions& options,
                              std::uint64_t samples, std::uint64_t seeds = 32) {
  Moments means;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const PixelSampler sampler(seed, 11, 7);  // any pixel
    double sum = 0;
    PathCounts counts;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
      sum += path_radiance(scene, ray, sampler, sample, options, counts).g;
    }
    means.add(sum / static_cast<double>(samples));
  }
  return means;
}

}  // namespace bandsaw::test
