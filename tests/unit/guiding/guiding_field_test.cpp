// A cell of path guiding holds the directions from which light comes to a place. The cells of a
// scene are in trees over the position and the normal of surfaces (GuidingTree). A tree is built
// from records of light that paths or photons found. A GuidingField has a tree of paths and a tree
// of photons.

#include "renderlib/guiding/guiding_field.h"

#include <gtest/gtest.h>

#include "renderlib/sampling/sampler.h"

namespace bandsaw {
namespace {

/// Returns records on both sides of the floor z = 0 over [0, 10]^2. The upper side is lit from
/// above one of its corners, and the lower side from below this corner.
std::vector<GuidingRecord> two_sides(std::uint64_t count) {
  std::vector<GuidingRecord> records;
  const PixelSampler sampler(1, 2, 3);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Sample4 at = sampler.group(i, 0);
    const double side = at[2] < 0.5 ? 1 : -1;
    records.push_back({.position = float3({10 * at[0], 10 * at[1], 0}),
                       .normal = float3({0, 0, side}),
                       .source = float3({at[3], 0, 4 * side}),
                       .weight = 1});
  }
  return records;
}

TEST(GuidingTree, SeparatesTheSidesOfASurface) {
  Pool pool(1);
  const GuidingTree tree(two_sides(4000), pool);
  EXPECT_GT(tree.cells(), 40u);  // a leaf has at most 48 of the 4,000 records
  for (const double side : {1.0, -1.0}) {
    const GuidingCell* cell = tree.find({5, 5, 0}, {0, 0, side});
    ASSERT_NE(cell, nullptr);
    ASSERT_GT(cell->count, 0u);
    EXPECT_GT(cell->balls[0].center[2] * side, 3);  // the light is at the height 4 of this side
  }
  EXPECT_EQ(tree.find({5, 5, 0}, {1, 0, 0}), nullptr);
}

TEST(GuidingTree, IsEmptyWithoutRecords) {
  Pool pool(1);
  const GuidingTree tree({}, pool);
  EXPECT_EQ(tree.cells(), 0u);
  EXPECT_EQ(tree.find({}, {0, 0, 1}), nullptr);
}

// A point cannot be divided further, and the records have two normals.
TEST(GuidingTree, ManyRecordsAtOnePointGiveAtMostTwoCells) {
  std::vector<GuidingRecord> records = two_sides(1000);
  for (GuidingRecord& record : records) {
    record.position = {1, 2, 3};
  }
  Pool pool(1);
  EXPECT_LE(GuidingTree(records, pool).cells(), 2u);
}

/// Returns true if the cells are equal, or both nullptr.
bool same(const GuidingCell* a, const GuidingCell* b) {
  if (a == nullptr || b == nullptr) {
    return a == b;
  }
  if (a->count != b->count || a->share != b->share || a->irradiance != b->irradiance) {
    return false;
  }
  for (std::uint32_t i = 0; i < a->count; ++i) {
    if (a->balls[i].center != b->balls[i].center || a->balls[i].radius != b->balls[i].radius ||
        a->balls[i].weight != b->balls[i].weight) {
      return false;
    }
  }
  return true;
}

TEST(GuidingField, IsTheSameForAnyNumberOfThreads) {
  std::vector<GuidingRecord> records = two_sides(6000);
  for (std::size_t i = 0; i < records.size(); i += 3) {
    records[i].kind = GuidingRecord::Kind::kPhoton;
  }
  Pool one(1);
  Pool three(3);
  const GuidingField a(records, one);
  const GuidingField b(records, three);
  EXPECT_EQ(a.cells(), b.cells());
  EXPECT_EQ(a.bytes(), b.bytes());
  const PixelSampler sampler(9, 9, 9);
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Sample4 at = sampler.group(i, 0);
    const Vec3 position{10 * at[0], 10 * at[1], 0};
    const Vec3 normal{0, 0, at[2] < 0.5 ? 1.0 : -1.0};
    const GuidingCells of_a = a.find(position, normal);
    const GuidingCells of_b = b.find(position, normal);
    ASSERT_TRUE(same(of_a.paths, of_b.paths));
    ASSERT_TRUE(same(of_a.photons, of_b.photons));
  }
}

}  // namespace
}  // namespace bandsaw
