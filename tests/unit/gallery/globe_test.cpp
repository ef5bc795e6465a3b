// The globe, a generated map of a planet that is a texture of scenes of the gallery: it has no
// seam, ice and sea are where they belong, and the planet is the same at every size. The map has
// twice as many columns as rows.

#include "renderlib/gallery/globe.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace bandsaw::gallery {
namespace {

using Codes = std::vector<std::uint8_t>;

Codes map_of(std::uint32_t rows, int threads = 2) {
  Pool pool(threads);
  return globe_map(rows, pool);
}

/// Returns the sRGB code of a channel of the texel (x, y) of a map with `rows` rows.
int code(const Codes& map, std::uint32_t rows, std::uint32_t x, std::uint32_t y, int channel) {
  return map[(std::size_t{y} * 2 * rows + x) * 3 + static_cast<std::size_t>(channel)];
}

TEST(Globe, IsTheSameFromAnyNumberOfThreads) {
  EXPECT_EQ(map_of(64, 1), map_of(64, 3));
  EXPECT_EQ(map_of(64).size(), 64u * 128 * 3);
}

// The first and last columns are neighbours on the sphere. Their difference is at most the largest
// difference of two other neighbouring columns.
TEST(Globe, HasNoSeam) {
  constexpr std::uint32_t kRows = 256;
  const Codes map = map_of(kRows);
  // Returns the sum of the differences of two columns.
  const auto step = [&](std::uint32_t x, std::uint32_t next) {
    long sum = 0;
    for (std::uint32_t y = 0; y < kRows; ++y) {
      for (int c = 0; c < 3; ++c) {
        sum += std::abs(code(map, kRows, x, y, c) - code(map, kRows, next, y, c));
      }
    }
    return sum;
  };
  long largest = 0;
  for (std::uint32_t x = 0; x + 1 < 2 * kRows; ++x) {
    largest = std::max(largest, step(x, x + 1));
  }
  EXPECT_LE(step(2 * kRows - 1, 0), largest);
}

// A texel is ice if its red is high. A texel is sea if its blue is more than twice its red. The
// middle row, which is the equator, has 256 texels.
TEST(Globe, HasIceAtThePolesAndSeaAndLandBetween) {
  constexpr std::uint32_t kRows = 128;
  const Codes map = map_of(kRows);
  int sea = 0;
  for (std::uint32_t x = 0; x < 2 * kRows; ++x) {
    EXPECT_GT(code(map, kRows, x, 0, 0), 230);
    EXPECT_GT(code(map, kRows, x, kRows - 1, 0), 230);
    sea += code(map, kRows, x, kRows / 2, 2) > 2 * code(map, kRows, x, kRows / 2, 0) ? 1 : 0;
  }
  EXPECT_GT(sea, 80);
  EXPECT_LT(sea, 240);
}

// Four texels of the larger map cover one texel of the smaller map. Their mean is close to the
// texel of the smaller map. Details that only the larger map has make a small difference.
TEST(Globe, IsTheSamePlanetAtEverySize) {
  constexpr std::uint32_t kRows = 128;
  const Codes small = map_of(kRows);
  const Codes large = map_of(2 * kRows);
  double difference = 0;
  for (std::uint32_t y = 0; y < kRows; ++y) {
    for (std::uint32_t x = 0; x < 2 * kRows; ++x) {
      for (int c = 0; c < 3; ++c) {
        const int four = code(large, 2 * kRows, 2 * x, 2 * y, c) +
                         code(large, 2 * kRows, 2 * x + 1, 2 * y, c) +
                         code(large, 2 * kRows, 2 * x, 2 * y + 1, c) +
                         code(large, 2 * kRows, 2 * x + 1, 2 * y + 1, c);
        difference += std::abs(four / 4.0 - code(small, kRows, x, y, c));
      }
    }
  }
  EXPECT_LT(difference / static_cast<double>(small.size()), 4);
}

}  // namespace
}  // namespace bandsaw::gallery
