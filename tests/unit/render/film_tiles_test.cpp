// Half tiles that take part in some passes only.

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/render/film.h"
#include "tests/unit/render/film_values.h"

namespace bandsaw {
namespace {

struct Part {
  SampleRange samples;
  TileMask tiles;
};

/// A third of the half tiles are left out of each of the nodes that cover the samples.
std::vector<Part> random_parts(std::uint64_t samples, const TileGrid& grid, Random& random) {
  std::vector<Part> parts;
  for (const SampleRange& node : random_nodes(samples, random)) {
    TileMask tiles(grid.width, {0, grid.height});
    for (std::uint32_t y = 0; y < grid.height; y += kTileSide) {
      for (std::uint32_t x = 0; x < grid.width; x += kTileSide) {
        for (const std::uint32_t half : {0, 1}) {
          if (random.below(3) != 0) {
            tiles.add(x + half, y);
          }
        }
      }
    }
    parts.push_back({node, tiles});
  }
  return parts;
}

/// The tree's node with zeros for what the pixel did not take.
double node_sum_of(const std::vector<Part>& parts, std::uint32_t x, std::uint32_t y, std::size_t k,
                   const SampleRange& node) {
  for (const Part& part : parts) {
    if (part.samples.first <= node.first && node.last <= part.samples.last) {
      return part.tiles.has(x, y) ? node_sum(y, k, node) : 0;
    }
  }
  const Halves halves = split(node);
  return node_sum_of(parts, x, y, k, halves.left) + node_sum_of(parts, x, y, k, halves.right);
}

TEST(Film, WhatIsLeftOutCountsAsZerosInTheTreeInAnyOrder) {
  const TileGrid grid{19, 18};
  Random random(3);
  for (const std::uint64_t samples : {96, 160, 256}) {
    const std::vector<Part> parts = random_parts(samples, grid, random);
    std::vector<std::pair<const Part*, std::uint32_t>> bands;
    for (const Part& part : parts) {
      for (std::uint32_t y = 0; y < grid.height; ++y) {
        bands.emplace_back(&part, y);
      }
    }
    for (std::size_t i = bands.size(); i > 1; --i) {
      std::swap(bands[i - 1], bands[random.below(static_cast<std::uint32_t>(i))]);
    }
    Film film = *Film::create(grid.width, grid.height, "", Film::Grain::kHalfTiles);
    for (const auto& [part, y] : bands) {
      const TileMask tiles = part->tiles.of({y, y + 1});
      ASSERT_TRUE(film.add(band_pixels({part->samples, {y, y + 1}}, grid.width), tiles).ok());
    }
    EXPECT_TRUE(film.complete(samples));
    EXPECT_EQ(film.snapshot().least_samples, samples);
    const Image image = film.snapshot().image;
    const Image counts = film.counts();
    for (std::uint32_t y = 0; y < grid.height; ++y) {
      for (std::uint32_t x = 0; x < grid.width; ++x) {
        double count = 0;
        for (const Part& part : parts) {
          count += part.tiles.has(x, y) ? static_cast<double>(part.samples.samples()) : 0;
        }
        ASSERT_EQ(counts.at(x, y).r, count);
        double total = 0;
        for (const SampleRange& node : maximal_nodes(samples)) {
          total += node_sum_of(parts, x, y, 3 * x, node);
        }
        ASSERT_EQ(image.at(x, y).r, count > 0 ? static_cast<float>(total / count) : 0) << x;
      }
    }
  }
}

// Right with uneven numbers of samples: the noise of each pixel is that of its own number.
TEST(Film, TheErrorOfUnevenNumbersOfSamplesIsTheirStandardError) {
  const TileGrid grid{128, 96};
  TileMask some(grid.width, {0, grid.height});
  for (std::uint32_t x = 0; x < grid.width; x += 2 * kTileSide) {
    for (std::uint32_t y = 0; y < grid.height; y += kTileSide) {
      some.add(x, y);
      some.add(x + 1, y);
    }
  }
  Film film = *Film::create(grid.width, grid.height, "", Film::Grain::kHalfTiles);
  Random random(11);
  const auto add = [&](const SampleRange& samples, const TileMask& tiles) {
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
  add({32, 64}, some);
  add({64, 128}, some);
  // Half of the pixels have 128 samples, the others 32.
  const double expected_error = std::sqrt((1.0 / 128 + 1.0 / 32) / 2 / 3);
  EXPECT_NEAR(film.error()->relative_rmse / expected_error, 1, 0.02);
  const std::vector<HalfTileErrors> tiles = film.tile_errors();
  ASSERT_EQ(tiles.size(), grid.half_tiles());
  double many = 0;
  double few = 0;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    for (const TileError& rows : tiles[i]) {
      EXPECT_EQ(rows.pixels, 64u);
      (i / 2 % 2 == 0 ? many : few) += rows.variance / static_cast<double>(tiles.size());
    }
  }
  EXPECT_NEAR(many * 3 * 128, 1, 0.05);
  EXPECT_NEAR(few * 3 * 32, 1, 0.05);
}

}  // namespace
}  // namespace bandsaw
