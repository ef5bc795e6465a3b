// Division of a band (a range of samples by a range of rows) into parts that need one photon map
// each. Consecutive samples share a map. PhotonMaps::number_of() returns the number of the map of a
// sample. Each of the first four maps has one block of 8 samples, and later maps have more blocks.

#include "renderlib/render/band_parts.h"

#include <gtest/gtest.h>

#include "renderlib/integrate/caustics.h"

namespace bandsaw {
namespace {

using Maps = std::vector<std::uint32_t>;
/// Number of samples of each of the first four maps.
constexpr std::uint64_t kSamplesOfMap = PhotonMaps::kMinSamplesOfMap;
static_assert(kSamplesOfMap == kBlockSamples);

TEST(BandParts, AWholeBandNeedsTheMapsOfItsSamples) {
  const BandPart part{{{16 * kSamplesOfMap, 32 * kSamplesOfMap}, {0, 16}}, {}};
  // Ten maps precede: four of kSamplesOfMap samples and six of twice as many.
  EXPECT_EQ(maps_of(part), (Maps{10, 11, 12, 13}));
  const auto [left, right] = halves_of(part, /*width=*/32);
  EXPECT_EQ(maps_of(left), (Maps{10, 11}));
  EXPECT_EQ(maps_of(right), (Maps{12, 13}));
  // The last block may be truncated.
  EXPECT_EQ(maps_of({{{0, kSamplesOfMap + 1}, {0, 16}}, {}}), (Maps{0, 1}));
}

// The image has two tiles of 16 x 16 pixels. A half tile is half of the pixels of a tile. The four
// half tiles have one, two, no and four blocks of samples. The band is divided until each part
// needs one map. Each sample of each half tile must be in one part.
TEST(BandParts, HalvesDivideTheSamplesOfAllHalfTiles) {
  TileSamples tiles(32, {0, 16});
  tiles.set(0, {kBlockSamples, 2 * kBlockSamples});
  tiles.set(1, {2 * kBlockSamples, 4 * kBlockSamples});
  tiles.set(3, {4 * kBlockSamples, 8 * kBlockSamples - 3});
  const BandPart part{{{0, kBlockSamples}, {0, 16}}, tiles};
  EXPECT_EQ(maps_of(part), (Maps{1, 2, 3, 4, 5}));
  std::vector<BandPart> open{part};
  std::vector<std::uint64_t> samples(4);
  while (!open.empty()) {
    const BandPart next = open.back();
    open.pop_back();
    if (maps_of(next).size() > 1) {
      const auto [left, right] = halves_of(next, 32);
      open.insert(open.end(), {left, right});
      continue;
    }
    // Two numbers for each half tile: its first sample and its number of samples.
    const std::vector<std::uint32_t> numbers = next.tiles.numbers();
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i] += numbers[2 * i + 1];
    }
  }
  EXPECT_EQ(samples, (std::vector<std::uint64_t>{kBlockSamples, 2 * kBlockSamples, 0,
                                                 4 * kBlockSamples - 3}));
}

// The film keeps the sums of two halves of the samples, [0, n) and [n, 2n), for the estimate of the
// error. If both halves shared a map, the noise of this map would be missing from the estimate.
TEST(BandParts, TheHalvesOfAnImageShareNoMap) {
  for (std::uint64_t half = kBlockSamples; half <= 1 << 20; half *= 2) {
    EXPECT_LT(PhotonMaps::number_of(half - 1), PhotonMaps::number_of(half)) << half;
  }
}

}  // namespace
}  // namespace bandsaw
