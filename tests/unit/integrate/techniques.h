#pragma once

// Compares the estimates of light sampling, of BSDF sampling and of both along one ray.

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/integrate/path.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace bandsaw::test {

/// Returns the mean and the variance of the green radiance along the ray, over `samples` samples of
/// different pixels.
inline Moments light_along(const SceneMaker& maker, const Ray& ray, int samples,
                           Technique technique = Technique::kBoth) {
  const auto scene = maker.build();
  Moments sum;
  PathCounts counts;
  const PathOptions options{.technique = technique};
  for (int i = 0; i < samples; ++i) {
    const PixelSampler sampler(5, static_cast<std::uint32_t>(i), 3);
    sum.add(path_radiance(*scene, ray, sampler, 0, options, counts).g);
  }
  return sum;
}

/// Checks mean radiances along the ray. The means of light sampling alone and of BSDF sampling
/// alone must each agree with the mean of both together, within 4 standard errors of the
/// difference. The mean of both together must be above `at_least`.
inline void expect_techniques_agree(const SceneMaker& maker, const Ray& ray, double at_least) {
  const Moments both = light_along(maker, ray, 20000);
  const Moments lights = light_along(maker, ray, 20000, Technique::kLightsOnly);
  const Moments scattering = light_along(maker, ray, 60000, Technique::kScatteringOnly);
  const auto agree = [](const Moments& a, const Moments& b) {
    return std::abs(a.mean() - b.mean()) <= 4 * std::hypot(a.standard_error(), b.standard_error());
  };
  EXPECT_GT(both.mean(), at_least);
  EXPECT_TRUE(agree(both, lights)) << both.mean() << " " << lights.mean();
  EXPECT_TRUE(agree(both, scattering)) << both.mean() << " " << scattering.mean();
}

}  // namespace bandsaw::test
