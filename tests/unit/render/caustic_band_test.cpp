// Tests of a scene whose caustics come from photon maps, rendered with the integrator path_guided.
// The pixels have the same bits for any number of threads and any division of the image into bands
// (ranges of samples by ranges of rows).

#include <gtest/gtest.h>

#include <algorithm>

#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/guiding_training.h"
#include "renderlib/integrate/photon_sources.h"
#include "renderlib/render/render_band.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

constexpr RenderSettings kSettings{
    .width = 21, .height = 18, .max_depth = 6, .seed = 5, .integrator = Integrator::kPathGuided};
/// Passed as the flag that stops a render. It is never set.
const std::atomic<bool> kGoOn = false;

/// A box with a glass ball below a small lamp. `closed`: the background is black, so neighbouring
/// pixels share paths (Scene::reuses_paths).
std::shared_ptr<const Scene> scene(bool closed) {
  test::SceneMaker maker = test::cornell_box();
  maker.sphere({190, 245, 170}, 80, maker.glass(1.5));
  maker.sphere({300, 450, 200}, 10, maker.lamp(200));
  if (!closed) {
    maker.background({0.2f, 0.2f, 0.2f}, {0.5f, 0.6f, 0.9f});
  }
  auto built = maker.build();
  EXPECT_EQ(built->reuses_paths(), closed);
  return built;
}

BandPixels render(const Scene& scene, const Band& band, int threads,
                  const TileSamples& tiles = {}) {
  Pool pool(threads);
  auto pixels = render_band(scene, kSettings, band, pool, kGoOn, {}, tiles);
  EXPECT_TRUE(pixels.ok()) << pixels.status();
  return *std::move(pixels);
}

TEST(CausticBand, HasPhotonMaps) {
  Pool pool(2);
  for (const bool closed : {true, false}) {
    const auto trained =
        train_guiding(*scene(closed), {21, 18, 6}, {pool, kGoOn}, /*photon_maps=*/true);
    EXPECT_FALSE(trained->sources->casters.empty());  // caustics come from photon maps
    EXPECT_TRUE(trained->sources->surfaces);          // indirect light comes from photon maps
  }
}

TEST(CausticBand, HasTheSameBitsForAnyThreadsAndRows) {
  for (const bool closed : {true, false}) {
    const BandPixels whole = render(*scene(closed), {{0, 32}, {0, 18}}, 1);
    EXPECT_EQ(whole.counters.bad_samples, 0u);
    EXPECT_EQ(render(*scene(closed), {{0, 32}, {0, 18}}, 3).sums, whole.sums);
    const auto rendered = scene(closed);
    std::vector<double> sums;
    for (const RowRange& rows : {RowRange{0, 5}, RowRange{5, 18}}) {
      const BandPixels part = render(*rendered, {{0, 32}, rows}, 2);
      sums.insert(sums.end(), part.sums.begin(), part.sums.end());
    }
    EXPECT_EQ(sums, whole.sums);
  }
}

// A node is a range of samples whose sum is the sum of its two halves. The node of 256 samples
// needs more photon maps than are held at once, so it is rendered in parts.
TEST(CausticBand, ANodeIsTheSumOfItsHalvesToTheBit) {
  const auto rendered = scene(false);
  const BandPixels whole = render(*scene(false), {{0, 256}, {9, 10}}, 2);
  const BandPixels left = render(*rendered, {{0, 128}, {9, 10}}, 2);
  const BandPixels right = render(*rendered, {{128, 256}, {9, 10}}, 2);
  for (std::size_t k = 0; k < whole.sums.size(); ++k) {
    ASSERT_EQ(whole.sums[k], left.sums[k] + right.sums[k]);
  }
  EXPECT_EQ(whole.counters.rays, left.counters.rays + right.counters.rays);
}

// In adaptive sampling, each half tile (half of the pixels of a tile of 16 x 16) takes its own
// range of samples, whatever the range of samples of the band is.
TEST(CausticBand, HalfTilesHaveTheSameBitsInAnyPass) {
  const auto rendered = scene(true);
  TileSamples tiles(21, {0, 16});
  tiles.set(0, {16, 32});
  tiles.set(1, {32, 64});
  const BandPixels some = render(*rendered, {{256, 272}, {0, 16}}, 2, tiles);
  const BandPixels first = render(*rendered, {{16, 32}, {0, 16}}, 2);
  const BandPixels second = render(*rendered, {{32, 64}, {0, 16}}, 2);
  for (std::uint32_t y = 0; y < 16; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x) {
      const std::size_t k = (y * 21 + x) * 3;
      ASSERT_EQ(some.sums[k], half_of(x, y) == 0 ? first.sums[k] : second.sums[k]);
    }
  }
}

// Progress is reported as the number of rows that are done. The band needs more photon maps than
// are held at once. A step of the training, or of making a photon map, is reported as 0 rows.
TEST(CausticBand, ProgressCountsEachRowOnce) {
  Pool pool(1);
  std::vector<std::uint32_t> rows;
  const auto pixels = render_band(*scene(false), kSettings, {{0, 256}, {9, 12}}, pool, kGoOn,
                                  [&](std::uint32_t done) { rows.push_back(done); });
  ASSERT_TRUE(pixels.ok());
  const auto steps = std::count(rows.begin(), rows.end(), 0u);
  // There are three rounds of training and more than eight maps. Each round and each map has 64
  // steps.
  EXPECT_GE(steps, 64 * 10);
  std::erase(rows, 0u);
  EXPECT_EQ(rows, (std::vector<std::uint32_t>{1, 2, 3}));
}

}  // namespace
}  // namespace bandsaw
