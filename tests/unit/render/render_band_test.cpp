// Rendering of bands (ranges of samples by ranges of rows): pixels have the same bits for any
// number of threads, any division of the image into bands and any order of the bands. An id such as
// C5 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/render/render_band.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "renderlib/integrate/path_reuse.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/render_image.h"
#include "renderlib/scene/guide_integrators.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

constexpr RenderSettings kSettings{.width = 13, .height = 11, .max_depth = 6, .seed = 5};
/// Passed as the flag that stops a render. It is never set.
const std::atomic<bool> kGoOn = false;

/// A scene with diffuse, metal, glass and two lights.
std::shared_ptr<const Scene> scene() {
  test::SceneMaker maker = test::cornell_box();
  maker.sphere({190, 245, 170}, 80, maker.glass(1.5));
  maker.sphere({400, 400, 300}, 60, maker.metal(0.9f, 0.2));
  maker.sphere({450, 60, 150}, 40, maker.lamp(3));
  maker.background({0.2f, 0.2f, 0.2f}, {0.5f, 0.6f, 0.9f});
  return maker.build();
}

BandPixels render(const Scene& scene, const Band& band, int threads) {
  Pool pool(threads);
  auto pixels = render_band(scene, kSettings, band, pool, kGoOn, {});
  EXPECT_TRUE(pixels.ok()) << pixels.status();
  return *std::move(pixels);
}

TEST(RenderBand, AnyNumberOfThreadsGivesTheSameBits) {
  const auto rendered = scene();
  const Band band{{0, 32}, {0, 11}};
  const BandPixels one = render(*rendered, band, 1);
  EXPECT_GT(one.counters.rays, 13u * 11 * 32);
  EXPECT_EQ(one.counters.bad_samples, 0u);
  EXPECT_GT(*std::max_element(one.sums.begin(), one.sums.end()), 0);
  for (const int threads : {2, 3, 8}) {
    const BandPixels many = render(*rendered, band, threads);
    EXPECT_EQ(many.sums, one.sums) << threads;
    EXPECT_EQ(many.counters, one.counters) << threads;
  }
}

// A half tile is half of the pixels of a tile of 16 x 16. Half tile 1 takes the samples [32, 64)
// although the band has the samples [256, 272). Half tile 0 takes no samples.
TEST(RenderBand, SkippedHalfTilesAreZeroAndOthersHaveTheSameBits) {
  const auto rendered = scene();
  TileSamples tiles(13, {0, 11});
  tiles.set(1, {32, 64});
  Pool pool(2);
  const auto some =
      render_band(*rendered, kSettings, {{256, 272}, {2, 11}}, pool, kGoOn, {}, tiles);
  const BandPixels all = render(*rendered, {{32, 64}, {2, 11}}, 1);
  ASSERT_TRUE(some.ok());
  for (std::uint32_t y = 2; y < 11; ++y) {
    for (std::uint32_t x = 0; x < 13; ++x) {
      const std::size_t k = ((y - 2) * 13 + x) * 3;
      ASSERT_EQ(some->sums[k], half_of(x, y) == 1 ? all.sums[k] : 0);
    }
  }
  // Half tile 1 has about half of the pixels.
  EXPECT_LT(some->counters.rays, all.counters.rays * 6 / 10);
}

TEST(RenderBand, EveryIntegratorGivesTheSameBitsForAnyBandsAndThreads) {
  const auto rendered = scene();
  for (int i = 0; i <= kLastIntegrator; ++i) {
    RenderSettings settings = kSettings;
    settings.integrator = static_cast<Integrator>(i);
    const auto sums = [&](const Band& band, int threads) {
      Pool pool(threads);
      return render_band(*rendered, settings, band, pool, kGoOn, {})->sums;
    };
    const std::vector<double> whole = sums({{0, 16}, {0, 11}}, 1);
    std::vector<double> parts = sums({{0, 16}, {0, 4}}, 3);
    const std::vector<double> rest = sums({{0, 16}, {4, 11}}, 2);
    parts.insert(parts.end(), rest.begin(), rest.end());
    EXPECT_EQ(parts, whole) << integrator_name(settings.integrator);
    EXPECT_GT(*std::max_element(whole.begin(), whole.end()), 0);
  }
  RenderSettings settings = kSettings;
  settings.integrator = static_cast<Integrator>(kLastGuideIntegrator + 1);  // does not exist
  EXPECT_FALSE(validate(settings).ok());
}

// The image has parts of two tiles of 16 x 16 pixels. In each row, the two half tiles of the second
// tile have two and three pixels.
TEST(RenderBand, C5_PathReuseGivesTheSameBitsForAnyBandsAndThreads) {
  const auto box = test::cornell_box().build();
  ASSERT_TRUE(box->reuses_paths());
  RenderSettings settings = kSettings;
  settings.width = 21;
  const auto rendered = [&](const Band& band, int threads, const TileSamples& tiles) {
    Pool pool(threads);
    return render_band(*box, settings, band, pool, kGoOn, {}, tiles)->sums;
  };
  const std::vector<double> whole = rendered({{32, 64}, {0, 11}}, 1, {});
  EXPECT_EQ(rendered({{32, 64}, {0, 11}}, 3, {}), whole);
  TileSamples tiles(21, {0, 11});
  tiles.set(1, {32, 64});
  tiles.set(2, {32, 64});
  for (const std::uint32_t rows : {1u, 3u, 7u}) {
    std::vector<double> sums;
    std::vector<double> some;
    for (std::uint32_t y = 0; y < 11; y += rows) {
      const Band band{{32, 64}, {y, std::min(y + rows, 11u)}};
      const std::vector<double> all_of_it = rendered(band, 2, {});
      const std::vector<double> some_of_it = rendered(band, 2, tiles);
      sums.insert(sums.end(), all_of_it.begin(), all_of_it.end());
      some.insert(some.end(), some_of_it.begin(), some_of_it.end());
    }
    EXPECT_EQ(sums, whole) << rows;
    for (std::size_t k = 0; k < whole.size(); ++k) {
      const std::size_t x = k / 3 % 21;
      const std::size_t y = k / 3 / 21;
      const bool takes_part =
          half_of(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)) == (x < 16 ? 1 : 0);
      ASSERT_EQ(some[k], takes_part ? whole[k] : 0) << x << ", " << y;
    }
  }
  test::report_hard_case("C5", "same bits in bands of 1, 3, 7 rows where pixels share paths");
}

// Light sampling, BSDF sampling, both, and both with guided directions have the same mean and
// different variances. Without light sampling a path traces fewer rays.
TEST(RenderBand, AllTechniquesHaveTheSameMean) {
  const auto box = test::cornell_box().build();
  const auto pixels = [&](Integrator integrator) {
    Pool pool(2);
    RenderSettings settings = kSettings;
    settings.max_depth = 2;
    settings.integrator = integrator;
    return *render_band(*box, settings, {{0, 1024}, {0, 11}}, pool, kGoOn, {});
  };
  const auto total = [](const BandPixels& band) {
    return std::accumulate(band.sums.begin(), band.sums.end(), 0.0);
  };
  const BandPixels both = pixels(Integrator::kPathPlain);
  const BandPixels lights = pixels(Integrator::kPathLights);
  const BandPixels scattering = pixels(Integrator::kPathScattering);
  const BandPixels guided = pixels(Integrator::kPathGuided);
  EXPECT_NE(both.sums, lights.sums);
  EXPECT_NE(both.sums, guided.sums);
  EXPECT_LT(scattering.counters.rays, both.counters.rays);
  // In the box, pixels share paths. With light sampling alone, fewer connections between the paths
  // of two pixels carry light, so there are fewer rays.
  EXPECT_LE(lights.counters.rays, both.counters.rays);
  EXPECT_NEAR(total(lights) / total(both), 1, 0.02);
  EXPECT_NEAR(total(guided) / total(both), 1, 0.02);
  EXPECT_NEAR(total(scattering) / total(both), 1, 0.04);
}

TEST(RenderBand, C5_RowsAreTheSameInEveryBand) {
  const auto rendered = scene();
  const BandPixels whole = render(*rendered, {{0, 16}, {0, 11}}, 2);
  for (const std::uint32_t rows : {1u, 3u, 7u}) {
    std::vector<double> sums;
    for (std::uint32_t y = 0; y < 11; y += rows) {
      const BandPixels part = render(*rendered, {{0, 16}, {y, std::min(y + rows, 11u)}}, 2);
      sums.insert(sums.end(), part.sums.begin(), part.sums.end());
    }
    EXPECT_EQ(sums, whole.sums) << rows;
  }
  test::report_hard_case("C5", "same bits in bands of 1, 3, 7 rows");
}

// A node is a range of samples that the summation tree of samples sums up (render/band.h).
TEST(RenderBand, A7_ANodeIsTheSumOfItsHalvesToTheBit) {
  const auto rendered = scene();
  for (const SampleRange& node : {SampleRange{0, 64}, {64, 128}, {0, 128}, {32, 60}, {0, 12}}) {
    const Halves halves = split(node);
    const BandPixels whole = render(*rendered, {node, {4, 6}}, 2);
    const BandPixels left = render(*rendered, {halves.left, {4, 6}}, 1);
    const BandPixels right = render(*rendered, {halves.right, {4, 6}}, 1);
    for (std::size_t k = 0; k < whole.sums.size(); ++k) {
      ASSERT_EQ(whole.sums[k], left.sums[k] + right.sums[k]);
    }
    EXPECT_EQ(whole.counters.rays, left.counters.rays + right.counters.rays);
  }
  test::report_hard_case("A7", "the sum of both halves equals the whole to the bit");
}

TEST(RenderBand, R6A7_BandsInAnyOrderEqualOneRender) {
  const auto rendered = scene();
  Pool pool(2);
  const std::uint64_t samples = 88;
  auto straight = render_image(*rendered, kSettings, samples, pool, kGoOn, {}, "");
  ASSERT_TRUE(straight.ok()) << straight.status();
  test::Random random(3);
  std::vector<Band> bands;
  for (const SampleRange& node : maximal_nodes(samples)) {
    bands.push_back({node, {0, 5}});
    const bool halved = node.blocks() > 1;
    const Halves halves = halved ? split(node) : Halves{node, {}};
    bands.push_back({halves.left, {5, 11}});
    if (halved) {
      bands.push_back({halves.right, {5, 11}});
    }
  }
  auto film = Film::create(kSettings.width, kSettings.height, "");
  ASSERT_TRUE(film.ok());
  while (!bands.empty()) {
    const std::uint32_t next = random.below(static_cast<std::uint32_t>(bands.size()));
    ASSERT_TRUE(film->add(render(*rendered, bands[next], 1)).ok());
    bands.erase(bands.begin() + next);
  }
  EXPECT_EQ(film->snapshot().image.pixels, straight->film.snapshot().image.pixels);
  EXPECT_EQ(film->snapshot().least_samples, samples);
  test::report_hard_case("R6", "same bits for bands in any order");
}

TEST(RenderBand, AnotherSeedGivesOtherSamples) {
  const auto rendered = scene();
  Pool pool(1);
  RenderSettings other = kSettings;
  other.seed = 6;
  const Band band{{0, 16}, {5, 6}};
  const auto pixels = render_band(*rendered, other, band, pool, kGoOn, {});
  ASSERT_TRUE(pixels.ok());
  EXPECT_NE(pixels->sums, render(*rendered, band, 1).sums);
}

TEST(RenderBand, ProgressCountsEachRowOnce) {
  const auto rendered = scene();
  Pool pool(3);
  Mutex mutex;
  std::multiset<std::uint32_t> seen;
  const auto done = [&](std::uint32_t rows) {
    MutexLock lock(mutex);
    seen.insert(rows);
  };
  ASSERT_TRUE(render_band(*rendered, kSettings, {{0, 16}, {2, 9}}, pool, kGoOn, done).ok());
  // 0 rows are reported during the pilot, a small training that decides whether guiding pays.
  seen.erase(0);
  EXPECT_EQ(seen, (std::multiset<std::uint32_t>{1, 2, 3, 4, 5, 6, 7}));
}

TEST(RenderBand, StoppingIsCancelledAndLeavesThePoolUsable) {
  const auto rendered = scene();
  Pool pool(2);
  std::atomic<bool> stop = false;
  for (const std::uint32_t at : {0u, 1u}) {  // in the pilot, and at the first row
    stop = false;
    const auto stop_there = [&](std::uint32_t rows) { stop = stop || rows == at; };
    const auto stopped =
        render_band(*rendered, kSettings, {{0, 16}, {0, 11}}, pool, stop, stop_there);
    EXPECT_EQ(stopped.status().code(), absl::StatusCode::kCancelled) << at;
  }
  EXPECT_TRUE(render_band(*rendered, kSettings, {{0, 16}, {0, 1}}, pool, kGoOn, {}).ok());
}

TEST(RenderBand, InvalidBandsAreRefused) {
  const auto rendered = scene();
  Pool pool(1);
  EXPECT_EQ(render_band(*rendered, kSettings, {{0, 16}, {0, 12}}, pool, kGoOn, {}).status().code(),
            absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(render_image(*rendered, kSettings, 0, pool, kGoOn, {}, "").status().code(),
            absl::StatusCode::kInvalidArgument);
}

TEST(RenderBand, A3_OverflowingSamplesAreCountedAndDiscarded) {
  // Inside glass, radiance is n^2 times that outside: 25 times 3e38 overflows a float.
  test::SceneMaker maker;
  maker.camera({0, 0, 0}, {0, 0, 1}, 20);
  maker.background({3e38f, 1, 0}, {3e38f, 1, 0});
  maker.sphere({0, 0, 0}, 1, maker.glass(5));
  const auto rendered = maker.build();
  Pool pool(1);
  const auto pixels =
      render_band(*rendered, {.width = 2, .height = 2}, {{16, 32}, {1, 2}}, pool, kGoOn, {});
  ASSERT_TRUE(pixels.ok());
  EXPECT_GT(pixels->counters.bad_samples, 0u);
  EXPECT_EQ(pixels->counters.bad_y, 1u);
  EXPECT_GE(pixels->counters.bad_sample, 16u);
  EXPECT_EQ(pixels->counters.negative_samples, 0u);
  for (const double sum : pixels->sums) {
    EXPECT_TRUE(std::isfinite(sum));
  }
  test::report_hard_case(
      "A3", "bad samples are left out of the sums and counted, and the first is named");
}

TEST(RenderBand, A3_APixelIsTheMeanOfItsFiniteSamples) {
  // Samples of the background overflow as in the test above. A quarter of all samples hits a small
  // emitter of radiance 1 in front of the camera. So the mean of the finite samples is 1.
  test::SceneMaker maker;
  maker.camera({0, 0, 0}, {0, 0, 1}, 20);
  maker.background({3e38f, 3e38f, 3e38f}, {3e38f, 3e38f, 3e38f});
  maker.sphere({0, 0, 0}, 1, maker.glass(5));
  maker.sphere({0, 0, 0.5}, 0.05, maker.lamp(1));
  const auto rendered = maker.build();
  Pool pool(1);
  const auto pixels = render_band(*rendered, {.width = 2, .height = 2, .max_depth = 64},
                                  {{0, 64}, {0, 2}}, pool, kGoOn, {});
  ASSERT_TRUE(pixels.ok());
  EXPECT_GT(pixels->counters.bad_samples, 64u);
  for (const double sum : pixels->sums) {
    EXPECT_NEAR(sum / 64, 1, 1e-12);
  }
  test::report_hard_case("A3", "a pixel is the mean of the good samples of each block of 8");
}

TEST(RenderBand, CountsTruncatedPathsAndDroppedPrimitives) {
  test::SceneMaker maker;
  maker.camera({0, 0, 0}, {0, 0, 1}, 20);
  maker.sphere({0, 0, 0}, 1, maker.diffuse(0.5f));
  maker.triangle({0, 0, 2}, {0, 0, 2}, {1, 0, 2}, maker.diffuse(0.5f));
  const auto rendered = maker.build();
  Pool pool(2);
  const auto pixels = render_band(*rendered, {.width = 3, .height = 2, .max_depth = 1},
                                  {{0, 16}, {0, 2}}, pool, kGoOn, {});
  ASSERT_TRUE(pixels.ok());
  EXPECT_EQ(pixels->counters.truncated_paths, 16u * 6);
  EXPECT_EQ(pixels->counters.dropped_primitives, 1u);
}

// passes_of(n) divides the samples [0, n) into passes. A pass is a node of the summation tree of
// samples: an aligned range of a power of two of blocks of 8 samples (render/band.h).
TEST(RenderImage, EachPassIsAsLongAsAllBeforeAndTheRestIsDividedIntoNodes) {
  EXPECT_TRUE(passes_of(0).empty());
  EXPECT_EQ(passes_of(8), (std::vector<SampleRange>{{0, 8}}));
  EXPECT_EQ(passes_of(64), (std::vector<SampleRange>{{0, 8}, {8, 16}, {16, 32}, {32, 64}}));
  EXPECT_EQ(passes_of(50),
            (std::vector<SampleRange>{{0, 8}, {8, 16}, {16, 32}, {32, 48}, {48, 50}}));
  EXPECT_EQ(passes_of(12), (std::vector<SampleRange>{{0, 8}, {8, 12}}));
}

// The canary is a hash of a small image, by which workers are compared with the coordinator.
TEST(Canary, DependsOnTheProgramAlone) {
  const std::uint64_t first = canary();
  EXPECT_EQ(canary(), first);
  EXPECT_NE(first, 0u);
}

}  // namespace
}  // namespace bandsaw
