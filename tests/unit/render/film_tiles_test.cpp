// The film holds the sums of an image, to which bands are added. In these tests, half tiles have
// their own numbers of samples, as adaptive sampling decides them. A half tile is half of the
// pixels of a tile of 16 x 16 pixels. In each pass it takes the samples of one node, or no samples.
// A node is an aligned range of 2^k blocks of 8 samples (render/band.h).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderlib/render/film.h"
#include "tests/unit/render/film_values.h"

namespace bandsaw {
namespace {

/// A pass: `tiles` says which samples each half tile takes. Uniform sampling would take `samples`.
struct Pass {
  SampleRange samples;
  TileSamples tiles;
};

/// Returns passes in each of which about two thirds of the half tiles take their next node.
std::vector<Pass> random_passes(std::uint64_t samples, const TileGrid& grid, Random& random) {
  std::vector<std::vector<SampleRange>> nodes(grid.half_tiles());
  for (std::vector<SampleRange>& of_half_tile : nodes) {
    of_half_tile = random_nodes(samples, random);
    std::sort(of_half_tile.rbegin(), of_half_tile.rend());
  }
  std::vector<Pass> passes;
  for (const SampleRange& node : random_nodes(samples, random)) {
    passes.push_back({node, TileSamples(grid.width, {0, grid.height})});
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!nodes[i].empty() && random.below(3) != 0) {
        passes.back().tiles.set(i, nodes[i].back());
        nodes[i].pop_back();
      }
    }
  }
  return passes;
}

/// Returns the band's sums as film_values.h defines them. They are 0 where a half tile takes no
/// samples.
BandPixels pixels_of(const Band& band, const TileGrid& grid, const TileSamples& tiles) {
  BandPixels pixels{.band = band, .width = grid.width, .sums = {}, .counters = {}};
  for (std::uint32_t y = band.rows.first; y < band.rows.last; ++y) {
    for (std::uint32_t x = 0; x < grid.width; ++x) {
      const SampleRange node = tiles.of_pixel(x, y, band.samples);
      for (const std::size_t k : {3 * x, 3 * x + 1, 3 * x + 2}) {
        pixels.sums.push_back(node.samples() > 0 ? node_sum(y, k, node) : 0);
      }
    }
  }
  return pixels;
}

// The bands of all passes are added in random order. Each pixel has its own number n of samples.
// The maximal nodes of n are the fewest nodes that tile the samples [0, n). The value of the pixel
// must be the sum of these nodes, divided by n.
TEST(Film, PixelsAreTheMeansOfTheirOwnSamplesInAnyOrder) {
  const TileGrid grid{19, 18};
  Random random(3);
  for (const std::uint64_t samples : {96, 160, 256}) {
    const std::vector<Pass> passes = random_passes(samples, grid, random);
    std::vector<std::pair<Band, TileSamples>> bands;
    for (const Pass& pass : passes) {
      for (std::uint32_t y = 0; y < grid.height; ++y) {
        std::vector<SampleRange> parts{pass.samples};
        if (pass.samples.blocks() > 1 && random.below(2) == 0) {
          const Halves halves = split(pass.samples);
          parts = {halves.left, halves.right};
        }
        for (const SampleRange& part : parts) {
          const Band band{part, {y, y + 1}};
          bands.emplace_back(band, pass.tiles.of(pass.samples, band));
        }
      }
    }
    for (std::size_t i = bands.size(); i > 1; --i) {
      std::swap(bands[i - 1], bands[random.below(static_cast<std::uint32_t>(i))]);
    }
    Film film = *Film::create(grid.width, grid.height, "", Film::Grain::kHalfTiles);
    for (const auto& [band, tiles] : bands) {
      ASSERT_TRUE(film.add(pixels_of(band, grid, tiles), tiles).ok());
      EXPECT_FALSE(film.add(pixels_of(band, grid, tiles), tiles).ok())
          << "a second copy must be refused";
    }
    // Samples that a half tile does not take count as covered.
    EXPECT_TRUE(film.complete(samples));
    EXPECT_EQ(film.snapshot().least_samples, samples);
    const Image image = film.snapshot().image;
    const Image counts = film.counts();
    for (std::uint32_t y = 0; y < grid.height; ++y) {
      for (std::uint32_t x = 0; x < grid.width; ++x) {
        std::uint64_t count = 0;
        for (const Pass& pass : passes) {
          count += pass.tiles.of_pixel(x, y, pass.samples).samples();
        }
        ASSERT_EQ(counts.at(x, y).r, static_cast<float>(count));
        double total = 0;
        for (const SampleRange& node : maximal_nodes(count)) {
          total += node_sum(y, 3 * x, node);
        }
        const double mean = count > 0 ? total / static_cast<double>(count) : 0;
        ASSERT_EQ(image.at(x, y).r, static_cast<float>(mean)) << x;
      }
    }
  }
}

// If pixels have different numbers of samples, the noise of each pixel follows from the pixel's own
// number.
TEST(Film, TheErrorIsTheStandardErrorAlsoIfPixelsHaveDifferentSampleCounts) {
  const TileGrid grid{128, 96};
  // Every other tile takes `samples`; the other tiles take none.
  const auto some = [&](const SampleRange& samples) {
    TileSamples tiles(grid.width, {0, grid.height});
    for (std::size_t i = 0; i < grid.half_tiles(); i += 4) {
      tiles.set(i, samples);
      tiles.set(i + 1, samples);
    }
    return tiles;
  };
  Film film = *Film::create(grid.width, grid.height, "", Film::Grain::kHalfTiles);
  Random random(11);
  const auto add = [&](const SampleRange& samples, const TileSamples& tiles) {
    BandPixels pixels{
        .band = {samples, {0, grid.height}}, .width = grid.width, .sums = {}, .counters = {}};
    for (std::size_t k = 0; k < std::size_t{grid.width} * grid.height * 3; ++k) {
      double sum = 0;
      for (std::uint64_t i = 0; i < samples.samples(); ++i) {
        sum += random.uniform(0, 2);
      }
      pixels.sums.push_back(sum);
    }
    ASSERT_TRUE(film.add(pixels, tiles).ok());
  };
  add({0, 16}, {});
  add({16, 32}, {});
  add({32, 64}, some({32, 64}));
  add({64, 128}, some({64, 128}));
  // Half of the pixels have 128 samples, the others 32. A sample has the mean 1 and the variance
  // 1/3.
  const double expected_error = std::sqrt((1.0 / 128 + 1.0 / 32) / 2 / 3);
  EXPECT_NEAR(film.error()->relative_rmse / expected_error, 1, 0.02);
  const std::vector<HalfTileErrors> tiles = film.tile_errors();
  ASSERT_EQ(tiles.size(), grid.half_tiles());
  double many = 0;
  double few = 0;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    for (const TileError& part : tiles[i]) {
      EXPECT_EQ(part.pixels, 64u);
      (i / 2 % 2 == 0 ? many : few) += part.variance / static_cast<double>(tiles.size());
    }
  }
  EXPECT_NEAR(many * 3 * 128, 1, 0.05);
  EXPECT_NEAR(few * 3 * 32, 1, 0.05);
}

}  // namespace
}  // namespace bandsaw
