// Grids of numbers in space, stored as bricks of 8 x 8 x 8 cells: numbers are stored exactly,
// interpolated between the centres of cells, bounded and checked. A half is a floating-point number
// of 16 bits.

#include "renderlib/medium/volume_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "renderlib/medium/brick_builder.h"
#include "renderlib/medium/grid_bounds.h"
#include "tests/support/grids.h"
#include "tests/support/random.h"

namespace bandsaw {
namespace {

using ::testing::HasSubstr;

TEST(Half, EveryHalfIsConvertedExactly) {
  for (std::uint32_t i = 0; i < 0x10000; ++i) {
    const auto half = static_cast<std::uint16_t>(i);
    const float value = half_to_float(half);
    if ((half & 0x7fffu) > 0x7c00u) {
      EXPECT_TRUE(std::isnan(value));
      continue;
    }
    const int exponent = half >> 10 & 31;
    const double mantissa = half & 0x3ff;
    const double size = exponent == 0    ? std::ldexp(mantissa, -24)
                        : exponent == 31 ? std::numeric_limits<double>::infinity()
                                         : std::ldexp(1024 + mantissa, exponent - 25);
    ASSERT_EQ(value, (half & 0x8000u) != 0 ? -size : size) << i;
    bool exact = true;
    ASSERT_EQ(float_to_half(value, &exact), half);
    ASSERT_TRUE(exact);
  }
}

TEST(Half, NumbersBetweenHalvesAreNotExact) {
  for (const float value :
       {1 + 0x1p-11f, 0x1p-25f, 65520.0f, 1e30f, 0.1f, std::numeric_limits<float>::quiet_NaN()}) {
    bool exact = true;
    float_to_half(value, &exact);
    EXPECT_FALSE(exact) << value;
  }
}

/// Returns the value that is stored in a cell of sparse(), a grid of 19 x 9 x 23 cells with empty
/// and full bricks.
float sparse_number(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return x < 8 && z > 7 ? 0.0f : static_cast<float>((x * 7 + y * 13 + z * 29) % 31) * 0.1f;
}
VolumeGrid sparse() { return test::grid_of({19, 9, 23}, {}, {1, 1, 1}, sparse_number); }

TEST(BrickBuilder, KeepsEveryNumber) {
  const VolumeGrid grid = sparse();
  ASSERT_TRUE(check_grid(grid).ok()) << check_grid(grid).status();
  EXPECT_EQ(*check_grid(grid), 3.0f);  // the largest number, 30 * 0.1
  EXPECT_EQ(grid.format, VolumeGrid::Format::kFloat32);
  EXPECT_EQ(grid.index.size(), 3 * 2 * 3 * 4u);
  // 3 x 2 x 3 bricks, of which 1 x 2 x 2 are empty.
  EXPECT_EQ(grid.values.size(), 14 * 512 * 4u);
  const GridReader reader(grid);
  for (std::uint32_t z = 0; z < 23; ++z) {
    for (std::uint32_t y = 0; y < 9; ++y) {
      for (std::uint32_t x = 0; x < 19; ++x) {
        ASSERT_EQ(reader.cell(x, y, z), sparse_number(x, y, z));
      }
    }
  }
}

// All bricks of the grid are equal, so only one brick is stored. Multiples of 0.25 are exact as
// halves, and multiples of 0.1 are not.
TEST(BrickBuilder, StoresEqualBricksOnceAndUsesHalvesIfTheyAreExact) {
  const auto layers = [](float step) {
    return test::grid_of({64, 64, 64}, {}, {1, 1, 1},
                         [step](std::uint32_t, std::uint32_t, std::uint32_t z) {
                           return static_cast<float>(z % 8) * step;
                         });
  };
  EXPECT_EQ(layers(0.25f).format, VolumeGrid::Format::kFloat16);
  EXPECT_EQ(layers(0.25f).values.size(), 512 * 2u);
  EXPECT_EQ(layers(0.1f).format, VolumeGrid::Format::kFloat32);
  EXPECT_EQ(layers(0.1f).values.size(), 512 * 4u);
  EXPECT_EQ(GridReader(layers(0.25f)).cell(63, 63, 63), 1.75f);
}

/// Returns the value that is stored in a cell. For a cell outside of the grid, the border decides:
/// kZero gives 0, and kClamp gives the value of the nearest cell.
double number_at(const VolumeGrid& grid, std::int64_t x, std::int64_t y, std::int64_t z) {
  const std::array<std::int64_t, 3> at = {x, y, z};
  std::array<std::uint32_t, 3> in{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t held = std::clamp<std::int64_t>(at[k], 0, grid.cells[k] - 1);
    if (held != at[k] && grid.border == VolumeGrid::Border::kZero) {
      return 0;
    }
    in[k] = static_cast<std::uint32_t>(held);
  }
  return GridReader(grid).cell(in[0], in[1], in[2]);
}

/// Trilinear interpolation by its definition, in double.
double reference(const VolumeGrid& grid, const Vec3& at) {
  const Vec3 q = at - Vec3{0.5, 0.5, 0.5};
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const std::array<double, 3> low = {std::floor(q.x), std::floor(q.y), std::floor(q.z)};
    const std::array<int, 3> up = {i & 1, i >> 1 & 1, i >> 2};
    const std::array<double, 3> p = {q.x, q.y, q.z};
    double weight = 1;
    std::array<std::int64_t, 3> cell{};
    for (std::size_t k = 0; k < 3; ++k) {
      weight *= up[k] != 0 ? p[k] - low[k] : 1 - (p[k] - low[k]);
      cell[k] = static_cast<std::int64_t>(low[k]) + up[k];
    }
    sum += weight * number_at(grid, cell[0], cell[1], cell[2]);
  }
  return sum;
}

TEST(GridReader, InterpolatesBetweenCellCentres) {
  for (const VolumeGrid::Border border : {VolumeGrid::Border::kZero, VolumeGrid::Border::kClamp}) {
    VolumeGrid grid = sparse();
    grid.border = border;
    const GridReader reader(grid);
    test::Random random(1);
    for (int i = 0; i < 20000; ++i) {
      const Vec3 at{19 * random.uniform(), 9 * random.uniform(), 23 * random.uniform()};
      ASSERT_NEAR(reader.value(at), reference(grid, at), 2e-6);
    }
  }
}

TEST(GridReader, IsZeroOutsideOfTheBox) {
  VolumeGrid grid = test::grid_of({8, 8, 8}, {}, {1, 1, 1}, [](auto, auto, auto) { return 1.0f; });
  for (const VolumeGrid::Border border : {VolumeGrid::Border::kZero, VolumeGrid::Border::kClamp}) {
    grid.border = border;
    const GridReader reader(grid);
    const float at_face = border == VolumeGrid::Border::kClamp ? 1.0f : 0.5f;
    EXPECT_EQ(reader.value({0, 4, 4}), at_face);
    EXPECT_EQ(reader.value({8, 4, 4}), at_face);
    for (const double out :
         {-1e-9, 8 + 1e-9, -1e300, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
      EXPECT_EQ(reader.value({out, 4, 4}), 0);
      EXPECT_EQ(reader.value({4, out, 4}), 0);
      EXPECT_EQ(reader.value({4, 4, out}), 0);
    }
  }
}

TEST(GridReader, NearestIsConstantInEachCell) {
  VolumeGrid grid = sparse();
  grid.filter = VolumeGrid::Filter::kNearest;
  const GridReader reader(grid);
  EXPECT_EQ(reader.value({9.01, 3.99, 2.5}), sparse_number(9, 3, 2));
  EXPECT_EQ(reader.value({19, 9, 23}), sparse_number(18, 8, 22));
}

TEST(GridReader, ReadsThreeChannels) {
  const VolumeGrid grid =
      dense_grid({2, 1, 1}, 3, [](std::size_t i) { return static_cast<float>(i); });
  EXPECT_EQ(GridReader(grid).color({0.5, 0.5, 0.5}), (Rgb{0, 1, 2}));
  EXPECT_EQ(GridReader(grid).color({1, 0.5, 0.5}), (Rgb{1.5f, 2.5f, 3.5f}));
  const VolumeGrid one = sparse();
  EXPECT_EQ(GridReader(one).color({9.5, 3.5, 2.5}), gray(sparse_number(9, 3, 2)));
}

TEST(GridBounds, ContainTheValuesOfEachBrick) {
  for (const VolumeGrid::Border border : {VolumeGrid::Border::kZero, VolumeGrid::Border::kClamp}) {
    VolumeGrid grid = sparse();
    grid.border = border;
    const GridReader reader(grid);
    const GridBounds bounds(grid);
    test::Random random(2);
    for (std::uint32_t brick = 0; brick < 3 * 2 * 3; ++brick) {
      const Vec3 low =
          8.0 * Vec3{static_cast<double>(brick % 3), static_cast<double>(brick / 3 % 2),
                     static_cast<double>(brick / 6)};
      const Vec3 high{std::min(low.x + 8, 19.0), std::min(low.y + 8, 9.0),
                      std::min(low.z + 8, 23.0)};
      const ValueBounds within = bounds.over(low, high);
      ValueBounds seen{1e9f, 0};
      for (int i = 0; i < 4000; ++i) {
        const Vec3 t{random.uniform(), random.uniform(), random.uniform()};
        const Vec3 size = high - low;
        const float value = reader.value(low + Vec3{t.x * size.x, t.y * size.y, t.z * size.z});
        seen = {std::min(seen.least, value), std::max(seen.most, value)};
      }
      EXPECT_LE(within.least, seen.least);
      EXPECT_GE(within.most, seen.most * (1 - 1e-6f));
    }
    EXPECT_EQ(bounds.over({-5, -5, -5}, {-1, 20, 40}).most, 0);
    EXPECT_EQ(bounds.over({-5, 0, 0}, {19, 9, 23}).least, 0);
  }
}

TEST(GridBounds, AreTightWhereTheDensityIsConstant) {
  VolumeGrid grid =
      test::grid_of({20, 20, 20}, {}, {1, 1, 1}, [](auto, auto, auto) { return 2.0f; });
  grid.border = VolumeGrid::Border::kClamp;
  const ValueBounds all = GridBounds(grid).over({0, 0, 0}, {20, 20, 20});
  EXPECT_EQ(all.least, 2);
  EXPECT_EQ(all.most, 2);
  grid.border = VolumeGrid::Border::kZero;
  EXPECT_EQ(GridBounds(grid).over({8, 8, 8}, {16, 16, 16}).least, 2);
  EXPECT_EQ(GridBounds(grid).over({0, 8, 8}, {8, 16, 16}).least, 0);
}

/// Returns the message of the error of an invalid grid; empty if the grid is valid.
std::string error_of(const VolumeGrid& grid) {
  return std::string(check_grid(grid).status().message());
}

/// Returns a copy of the bytes in which the four bytes from `at` on are `word`.
SharedBytes with(const SharedBytes& bytes, std::size_t at, std::uint32_t word) {
  std::vector<std::byte> copy(bytes.begin(), bytes.end());
  std::memcpy(copy.data() + at, &word, sizeof(word));
  return copy;
}

TEST(CheckGrid, RefusesFieldsThatAreOutOfRange) {
  const VolumeGrid good = sparse();
  const auto changed = [&](auto change) {
    VolumeGrid grid = good;
    change(grid);
    return error_of(grid);
  };
  EXPECT_EQ(changed([](VolumeGrid&) {}), "");
  EXPECT_THAT(changed([](VolumeGrid& g) { g.cells[1] = 0; }),
              HasSubstr(".cells: must be in [1, 1048576], is 0"));
  EXPECT_THAT(changed([](VolumeGrid& g) {
                g.cells = {1u << 20, 1u << 20, 1u << 20};
              }),
              HasSubstr(".cells: must be at most 67108864 bricks"));
  EXPECT_THAT(changed([](VolumeGrid& g) { g.channels = 2; }),
              HasSubstr(".channels: must be 1 or 3, is 2"));
  EXPECT_THAT(changed([](VolumeGrid& g) {
                g.to_medium = scaling({0, 1, 1});
              }),
              HasSubstr(".to_medium: must not be singular"));
  EXPECT_THAT(changed([](VolumeGrid& g) { g.cells[0] = 25; }),
              HasSubstr(".index: must have 96 bytes for 24 bricks, has 72"));
  EXPECT_THAT(changed([](VolumeGrid& g) { g.channels = 3; }), HasSubstr(".values: must be bricks"));
  EXPECT_THAT(changed([](VolumeGrid& g) { g.index = with(g.index, 4, 14); }),
              HasSubstr(".index[1]: must be below 14, is 14"));
  EXPECT_THAT(changed([](VolumeGrid& g) { g.values = with(g.values, 40, 0x7fc00000); }),
              HasSubstr(".values[10]: must be finite and >= 0, is nan"));
  EXPECT_THAT(changed([](VolumeGrid& g) { g.values = with(g.values, 40, 0xbf800000); }),
              HasSubstr(".values[10]: must be finite and >= 0, is -1"));
  EXPECT_THAT(changed([](VolumeGrid& g) { g.cells[0] = 18; }),
              HasSubstr(".values: must be 0 outside of the box"));
}

}  // namespace
}  // namespace bandsaw
