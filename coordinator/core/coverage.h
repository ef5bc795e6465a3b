#pragma once

// Of one pass, row by row: what is stored, what is leased and what is free.
//
// The rows are cut into strips of equal content, and the pass's samples in each strip into cells,
// each a node of the summation tree with one owner. Strips and cells partition the pass at all
// times, so nothing can be forgotten and nothing can have two owners. Most strips have one cell; a
// row that is more work than a band should be has several.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// Who has a cell: a lease's id, or one of these two.
using Owner = LeaseId;
inline constexpr Owner kFree = 0;
inline constexpr Owner kStored = ~Owner{0};

class Coverage {
 public:
  /// `pass` is a node; height > 0.
  Coverage(const SampleRange& pass, std::uint32_t height);

  /// What a change of owner did: the rows that have changed hands, ascending, and the leases that
  /// lost cells by it.
  struct Change {
    std::vector<RowRange> rows;
    std::vector<LeaseId> overtaken;
  };

  /// Gives the band's rows to `owner`. Rows of which some of these samples are stored already keep
  /// what they have: the film cannot take a part of a node. A lease that loses a part of its
  /// samples in a row loses that row: the rest becomes free.
  Change assign(const Band& band, Owner owner);

  /// What the lease still has of its band becomes free.
  void give_back(const Band& band, LeaseId lease);

  /// Of what is stored of the band, each cell that is a part of its node, or that its node is a
  /// part of, becomes free as far as the band goes.
  void reopen(const Band& band);

  /// Rows of the band of whose samples nothing is stored, ascending.
  std::vector<RowRange> wanted(const Band& band) const;
  /// Whether some row is wanted and no wanted row is leased.
  bool adoptable(const Band& band) const;
  /// Whether the lease still has some of its band.
  bool holds(const Band& band, LeaseId lease) const;

  /// The first free piece that begins in or below `row`: a node, and rows that all have it free.
  std::optional<Band> free_from(std::uint32_t row) const;
  /// The same of the rows from `row` on that are alike, if something is free in it.
  std::optional<Band> free_at(std::uint32_t row) const;

  bool complete() const { return stored_ == total_; }
  bool any_free() const { return !with_free_.empty(); }
  /// Sums over the rows, in samples a pixel column.
  std::uint64_t free_samples() const { return free_; }
  std::uint64_t stored_samples() const { return stored_; }

  const SampleRange& pass() const { return pass_; }
  std::uint32_t height() const { return height_; }

  /// Nothing when strips and cells partition the pass and the counts are right; else what is wrong.
  /// `f` is called with each lease that owns a cell.
  template <class F>
  std::optional<std::string> check(F f) const;

 private:
  struct Cell {
    SampleRange node;
    Owner owner = kFree;
    friend bool operator==(const Cell&, const Cell&) = default;
  };
  struct Strip {
    std::uint32_t last = 0;   ///< rows [key, last)
    std::vector<Cell> cells;  ///< left to right
  };
  using Strips = std::map<std::uint32_t, Strip>;

  static bool stored_in(const Strip& strip, const SampleRange& node);
  static void put(Strip& strip, const SampleRange& node, Owner owner, std::vector<LeaseId>& lost);
  static void open(Strip& strip, const SampleRange& node);
  static void merge_siblings(Strip& strip);
  static std::optional<SampleRange> free_in(const Strip& strip);
  Strips::const_iterator strip_at(std::uint32_t row) const;
  void cut_at(std::uint32_t row);
  void join(const RowRange& rows);
  void count(std::uint32_t first, const Strip& strip);
  void uncount(std::uint32_t first, const Strip& strip);
  std::optional<std::string> broken_partition() const;

  SampleRange pass_;
  std::uint32_t height_;
  Strips strips_;
  std::set<std::uint32_t> with_free_;  ///< keys of strips with a free cell
  std::uint64_t total_;
  std::uint64_t free_ = 0;
  std::uint64_t stored_ = 0;
};

template <class F>
std::optional<std::string> Coverage::check(F f) const {
  for (const auto& [first, strip] : strips_) {
    for (const Cell& cell : strip.cells) {
      if (cell.owner != kFree && cell.owner != kStored) {
        f(cell.owner, Band{cell.node, {first, strip.last}});
      }
    }
  }
  return broken_partition();
}

}  // namespace bandsaw::coordinator
