// Bands (ranges of rows by ranges of samples): the nodes of the summation tree, validation, and
// counters. The summation tree is a fixed binary tree in which the samples of a pixel are added up.
// So the sum has the same bits however the samples are divided into bands.

#include "renderlib/render/band.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bandsaw {
namespace {

/// Returns true if the range of samples is a node of the summation tree by the definition. A node
/// of level l and index i has 2^l blocks of 8 samples. Its first block has the number i * 2^l. Its
/// last block may be truncated.
bool is_node_by_definition(std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t blocks = 1; blocks <= 64; blocks *= 2) {
    for (std::uint64_t index = 0; index < 64; ++index) {
      const std::uint64_t begin = index * blocks * 8;
      const std::uint64_t end = begin + blocks * 8;
      if (first == begin && last <= end && last > end - 8) {
        return true;
      }
    }
  }
  return false;
}

TEST(Band, NodesAreAlignedPowersOfTwoOfBlocks) {
  for (std::uint64_t first = 0; first < 300; ++first) {
    for (std::uint64_t last = 0; last < 600; ++last) {
      ASSERT_EQ(is_node({first, last}), is_node_by_definition(first, last))
          << "[" << first << ", " << last << ")";
    }
  }
}

TEST(Band, HugeRangesAreNotNodes) {
  EXPECT_FALSE(is_node({0, ~std::uint64_t{0}}));
  EXPECT_FALSE(is_node({~std::uint64_t{0} - 7, ~std::uint64_t{0}}));
}

TEST(Band, MaximalNodesTileTheSamplesAndNoTwoCanBeMerged) {
  EXPECT_TRUE(maximal_nodes(0).empty());
  for (std::uint64_t samples = 1; samples < 3000; ++samples) {
    const std::vector<SampleRange> nodes = maximal_nodes(samples);
    std::uint64_t at = 0;
    std::uint64_t blocks = ~std::uint64_t{0};
    for (const SampleRange& node : nodes) {
      ASSERT_TRUE(is_node(node));
      ASSERT_EQ(node.first, at);
      ASSERT_LT(node.blocks(), blocks) << samples;  // sizes decrease, so no two nodes can be merged
      at = node.last;
      blocks = node.blocks();
    }
    ASSERT_EQ(at, samples);
  }
}

TEST(Band, HalvesOfANodeAreNodesThatTileIt) {
  for (std::uint64_t first = 0; first < 512; first += 8) {
    for (std::uint64_t last = first + 9; last <= 1024; ++last) {
      if (!is_node({first, last})) {
        continue;
      }
      const Halves halves = split({first, last});
      ASSERT_TRUE(is_node(halves.left));
      ASSERT_TRUE(is_node(halves.right)) << first << " " << last;
      ASSERT_EQ(halves.left.first, first);
      ASSERT_EQ(halves.left.last, halves.right.first);
      ASSERT_EQ(halves.right.last, last);
      ASSERT_EQ(halves.left.samples(), halves.left.blocks() * kBlockSamples);
      ASSERT_EQ(halves.left.blocks(), halves.right.blocks());
    }
  }
}

TEST(Band, InvalidBandsAreRefusedWithTheField) {
  const RenderSettings settings{.width = 8, .height = 10};
  EXPECT_TRUE(validate(Band{{0, 32}, {0, 10}}, settings).ok());
  EXPECT_TRUE(validate(Band{{32, 40}, {3, 4}}, settings).ok());
  const auto message = [&](const Band& band) {
    return std::string(validate(band, settings).message());
  };
  EXPECT_EQ(message({{0, 16}, {4, 11}}), "rows: must be a range within [0, 10), are [4, 11)");
  EXPECT_EQ(message({{0, 16}, {4, 4}}), "rows: must be a range within [0, 10), are [4, 4)");
  EXPECT_TRUE(message({{16, 48}, {0, 1}}).starts_with("samples: "));
  EXPECT_TRUE(message({{kMaxSamples, kMaxSamples + 16}, {0, 1}}).starts_with("samples: "));
  EXPECT_FALSE(validate(Band{{0, 16}, {0, 1}}, {.width = 0}).ok());
}

TEST(Band, SettingsOutOfRangeAreRefusedWithTheField) {
  EXPECT_TRUE(validate(RenderSettings{}).ok());
  EXPECT_EQ(validate(RenderSettings{.width = 70000}).message(),
            "width: must be in [1, 65536], is 70000");
  EXPECT_EQ(validate(RenderSettings{.height = 0}).message(), "height: must be in [1, 65536], is 0");
  EXPECT_EQ(validate(RenderSettings{.width = 65536, .height = 65536}).message(),
            "width x height: must be in [1, 64000000], is 4294967296");
  EXPECT_EQ(validate(RenderSettings{.max_depth = 1025}).message(),
            "max_depth: must be in [1, 1024], is 1025");
}

// Bad samples are NaN, infinite or negative. The first one is that with the lowest row, then the
// lowest column, then the lowest sample number. `rays` only tells the four parts apart.
TEST(Band, CountersKeepTheFirstBadSampleInAnyOrderOfAdding) {
  std::vector<Counters> parts = {
      {.rays = 1, .bad_samples = 1, .bad_x = 9, .bad_y = 2, .bad_sample = 0},
      {.rays = 2},
      {.rays = 3, .bad_samples = 2, .bad_x = 1, .bad_y = 3, .bad_sample = 0},
      {.rays = 4, .bad_samples = 1, .bad_x = 9, .bad_y = 2, .bad_sample = 7}};
  std::sort(parts.begin(), parts.end(),
            [](const Counters& a, const Counters& b) { return a.rays < b.rays; });
  do {
    Counters sum;
    for (const Counters& part : parts) {
      sum.add(part);
    }
    EXPECT_EQ(sum, (Counters{.rays = 10, .bad_samples = 4, .bad_x = 9, .bad_y = 2}));
  } while (
      std::next_permutation(parts.begin(), parts.end(),
                            [](const Counters& a, const Counters& b) { return a.rays < b.rays; }));
}

// Dropped primitives and training rays are counts of the scene, not of a band, so they are not
// added up. Techniques are flags, which are combined.
TEST(Band, CountersAddUpExceptThoseOfTheScene) {
  Counters sum = {
      .bad_samples = 2, .negative_samples = 1, .truncated_paths = 7, .dropped_primitives = 3};
  sum.add({.bad_samples = 1, .negative_samples = 1, .truncated_paths = 1, .dropped_primitives = 3});
  EXPECT_EQ(sum.negative_samples, 2u);
  EXPECT_EQ(sum.truncated_paths, 8u);
  EXPECT_EQ(sum.dropped_primitives, 3u);
  sum.add({.techniques = Counters::kPathGuiding, .training_rays = 5});
  sum.add({.techniques = Counters::kPhotonMaps, .training_rays = 5});
  sum.add({.techniques = Counters::kPortals, .training_rays = 5});
  sum.add({.techniques = Counters::kIndirectMaps, .training_rays = 5});
  EXPECT_EQ(sum.techniques, Counters::kAllTechniques);
  EXPECT_EQ(sum.training_rays, 5u);
}

}  // namespace
}  // namespace bandsaw
