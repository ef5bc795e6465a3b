#pragma once

// Compares paths with and without photon maps, which must have the same mean.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdint>

#include "renderlib/integrate/guiding_training.h"
#include "renderlib/integrate/make_photon_maps.h"
#include "renderlib/integrate/path.h"
#include "tests/support/statistics.h"

namespace bandsaw::test {

/// The size of a comparison. Each map has photons of its own.
struct MeanComparison {
  std::uint32_t max_depth = 0;
  std::uint32_t maps = 0;
  std::uint32_t paths = 0;    ///< for each map
  std::uint64_t photons = 0;  ///< photons that are started for the caustics of each map
  double max_deviation = 0;   ///< maximum standard error of the difference, relative to the mean
};

/// Expects the mean radiance along rays near `ray` to be the same with maps of these sources and
/// without maps. The tolerance is 4 standard errors (a false alarm in 1 of 16,000 comparisons) plus
/// 1 % for the blur of the maps. The paths without maps are guided, because they would be too noisy
/// otherwise.
inline void expect_same_mean(const Scene& scene, const PhotonSources& sources, const Ray& ray,
                             const MeanComparison& size) {
  const std::atomic<bool> never_stop = false;
  Pool pool(2);
  const auto guiding = train_guiding(scene, {64, 64, size.max_depth}, {pool, never_stop});
  Moments with;
  Moments without;
  PathCounts counts;
  for (std::uint32_t number = 0; number < size.maps; ++number) {
    const auto traced = make_photon_maps(
        scene, sources, {.seed = 3, .number = number, .photons = size.photons}, {pool, never_stop});
    PhotonMaps maps(sources.casters);
    maps.use_for_all(*traced);
    const PathOptions mapped{.max_depth = size.max_depth, .maps = &maps};
    const PathOptions guided{.max_depth = size.max_depth, .guiding = &guiding->field};
    Moments of_map;
    for (std::uint32_t i = 0; i < size.paths; ++i) {
      const PixelSampler sampler(5, i, number);
      // The directions differ a little, so that more places of each map are tested.
      const Vec3 aside{0.0004 * (i % 32) - 0.0064, 0.0004 * (i / 32) - 0.0064, 0};
      const Ray near{.origin = ray.origin, .direction = normalize(ray.direction + aside * 20)};
      of_map.add(path_radiance(scene, near, sampler, 0, mapped, counts).g);
      without.add(path_radiance(scene, near, sampler, 0, guided, counts).g);
    }
    with.add(of_map.mean());
  }
  const double deviation = std::hypot(with.standard_error(), without.standard_error());
  EXPECT_LE(std::abs(with.mean() - without.mean()), 4 * deviation + 0.01 * without.mean())
      << with.mean() << " and " << without.mean();
  EXPECT_LT(deviation, size.max_deviation * without.mean());
}

}  // namespace bandsaw::test
