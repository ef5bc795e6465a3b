// A pass is a range of samples of the whole image. For each row of a pass, Coverage knows the owner
// of every sample: the id of a lease (here mostly 7), kStored or kFree. A row of a band is wanted
// if none of the band's samples is stored in the row. Random operations are compared with plain
// bookkeeping.

#include "coordinator/scheduler/model/coverage.h"

#include <gtest/gtest.h>

#include "sim_time.h"

namespace bandsaw::coordinator {
namespace {

/// Returns the invariant that is broken; empty if there is none.
std::string check(const Coverage& coverage) {
  return coverage.check([](LeaseId, const Band&) {}).value_or("");
}

TEST(Coverage, BeginsAsOneFreePiece) {
  const Coverage coverage({0, 64}, 10);
  EXPECT_EQ(coverage.free_from(0), (Band{{0, 64}, {0, 10}}));
  EXPECT_EQ(coverage.free_samples(), 640u);
  EXPECT_FALSE(coverage.complete());
}

TEST(Coverage, ARowIsCompleteOnceAllItsPartsAreStored) {
  Coverage coverage({64, 128}, 1);
  coverage.assign({{64, 96}, {0, 1}}, 7);
  EXPECT_EQ(coverage.free_from(0), (Band{{96, 128}, {0, 1}}));
  coverage.assign({{96, 128}, {0, 1}}, kStored);
  coverage.assign({{64, 96}, {0, 1}}, kStored);
  EXPECT_TRUE(coverage.complete());
  EXPECT_TRUE(coverage.wanted({{64, 128}, {0, 1}}).empty());
}

TEST(Coverage, APassThatIsCutOffAtTheJobsLastSampleSplitsAtItsBlocks) {
  Coverage coverage({16, 28}, 1);
  coverage.assign({{16, 24}, {0, 1}}, 7);
  EXPECT_EQ(coverage.free_from(0), (Band{{24, 28}, {0, 1}}));
  coverage.give_back({{16, 24}, {0, 1}}, 7);
  EXPECT_EQ(coverage.free_from(0), (Band{{16, 28}, {0, 1}}));
}

TEST(Coverage, AWholeRowIsNotWantedOnceAPartOfItIsStored) {
  Coverage coverage({0, 32}, 3);
  coverage.assign({{0, 16}, {1, 2}}, kStored);
  const std::vector<RowRange> wanted = {{0, 1}, {2, 3}};
  EXPECT_EQ(coverage.wanted({{0, 32}, {0, 3}}), wanted);
  const Coverage::Change change = coverage.assign({{0, 32}, {0, 3}}, kStored);
  EXPECT_EQ(change.rows, wanted);
  EXPECT_EQ(coverage.free_from(0), (Band{{16, 32}, {1, 2}}));
}

TEST(Coverage, ALeaseThatLosesAPartOfARowLosesTheRow) {
  Coverage coverage({0, 32}, 2);
  coverage.assign({{0, 32}, {0, 2}}, 7);
  const Coverage::Change change = coverage.assign({{16, 32}, {0, 1}}, kStored);
  EXPECT_EQ(change.overtaken, std::vector<LeaseId>{7});
  EXPECT_TRUE(coverage.holds({{0, 32}, {0, 2}}, 7));
  EXPECT_FALSE(coverage.holds({{0, 32}, {0, 1}}, 7));
  EXPECT_EQ(coverage.free_from(0), (Band{{0, 16}, {0, 1}}));
}

// A band is adoptable if it has a wanted row, and no lease owns samples of the band in a wanted
// row. Then a new lease of the band can own all wanted rows.
TEST(Coverage, ABandIsAdoptableIfItHasWantedRowsAndNoneIsLeased) {
  Coverage coverage({0, 16}, 4);
  coverage.assign({{0, 16}, {0, 1}}, kStored);
  EXPECT_TRUE(coverage.adoptable({{0, 16}, {0, 4}}));
  EXPECT_FALSE(coverage.adoptable({{0, 16}, {0, 1}}));
  coverage.assign({{0, 16}, {3, 4}}, 7);
  EXPECT_FALSE(coverage.adoptable({{0, 16}, {0, 4}}));
  EXPECT_TRUE(coverage.adoptable({{0, 16}, {1, 3}}));
}

/// Bookkeeping with one owner for each block of 8 samples of each row.
class Plain {
 public:
  Plain(std::uint64_t blocks, std::uint32_t height) : blocks_(blocks), cells_(blocks * height) {}

  /// Returns true if any block of the node (an aligned range of 2^k blocks) is stored in the row.
  bool stored(std::uint32_t row, const SampleRange& node) const {
    bool any = false;
    for (std::uint64_t b = node.first_block(); b < node.first_block() + node.blocks(); ++b) {
      any = any || cells_[row * blocks_ + b] == kStored;
    }
    return any;
  }
  /// Gives the band's rows to the owner, except rows in which a block of the band is stored.
  void assign(const Band& band, Owner owner) {
    for (std::uint32_t row = band.rows.first; row < band.rows.last; ++row) {
      if (stored(row, band.samples)) {
        continue;
      }
      const std::uint64_t first = band.samples.first_block();
      for (std::uint64_t b = first; b < first + band.samples.blocks(); ++b) {
        lose_row(row, cells_[row * blocks_ + b]);
      }
      for (std::uint64_t b = first; b < first + band.samples.blocks(); ++b) {
        cells_[row * blocks_ + b] = owner;
      }
    }
  }
  void give_back(Owner lease) { std::replace(cells_.begin(), cells_.end(), lease, kFree); }
  std::uint64_t count(Owner owner) const {
    return static_cast<std::uint64_t>(std::count(cells_.begin(), cells_.end(), owner));
  }

 private:
  /// Frees what the lease owns in the row: a lease that loses a part of a row loses the whole row.
  void lose_row(std::uint32_t row, Owner lease) {
    for (std::uint64_t b = 0; b < blocks_ && lease != kFree; ++b) {
      Owner& cell = cells_[row * blocks_ + b];
      cell = cell == lease ? kFree : cell;
    }
  }
  std::uint64_t blocks_;
  std::vector<Owner> cells_;
};

TEST(Coverage, AgreesWithPlainBookkeepingInRandomOperations) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    sim::Chance chance(seed);
    const std::uint64_t blocks = std::uint64_t{1} << chance.pick(0, 4);
    const auto height = static_cast<std::uint32_t>(chance.pick(1, 12));
    Coverage coverage({0, blocks * kBlockSamples}, height);
    Plain plain(blocks, height);
    std::map<LeaseId, Band> leases;
    for (LeaseId id = 1; id <= 60; ++id) {
      const std::uint64_t size = std::uint64_t{1} << chance.pick(0, 4);
      const std::uint64_t length = std::min(size, blocks);
      const std::uint64_t at = chance.pick(0, blocks / length - 1) * length;
      const auto first = static_cast<std::uint32_t>(chance.pick(0, height - 1));
      const auto last = static_cast<std::uint32_t>(chance.pick(first + 1, height));
      const Band band{{at * kBlockSamples, (at + length) * kBlockSamples}, {first, last}};
      if (chance.happens(0.3) && !leases.empty()) {
        coverage.give_back(leases.begin()->second, leases.begin()->first);
        plain.give_back(leases.begin()->first);
        leases.erase(leases.begin());
      } else if (chance.happens(0.5)) {
        coverage.assign(band, kStored);
        plain.assign(band, kStored);
      } else {
        coverage.assign(band, id);
        plain.assign(band, id);
        leases[id] = band;
      }
      ASSERT_EQ(check(coverage), "") << "seed " << seed;
      ASSERT_EQ(coverage.stored_samples(), plain.count(kStored) * kBlockSamples) << seed;
      ASSERT_EQ(coverage.free_samples(), plain.count(kFree) * kBlockSamples) << seed;
    }
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
