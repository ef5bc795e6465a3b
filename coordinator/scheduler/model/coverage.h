#pragma once

// Records for each sample of each row of one pass whether it is leased (and by which lease), stored
// or free. A pass is a range of samples of the whole image.
//
// The rows are cut into strips, and the pass's samples in each strip into cells. Each cell has one
// owner, and is a node of the summation tree (renderlib/render/band.h): an aligned power-of-two
// number of blocks of 8 samples, whose sum is added to the film (the sums of all pixels) as a
// whole. Strips and cells partition the pass at all times, so no sample can be forgotten and none
// can have two owners. Most strips have one cell. A strip has several cells if one of its rows is
// more work than a band should be.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/ids.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// Owner of a cell: the id of a lease, or one of these two values.
using Owner = LeaseId;
inline constexpr Owner kFree = 0;
inline constexpr Owner kStored = ~Owner{0};

class Coverage {
 public:
  /// At first all of the pass is free. `pass` MUST be a node; `height`: rows of the image, > 0.
  Coverage(const SampleRange& pass, std::uint32_t height);

  /// The effect of assign().
  struct Change {
    std::vector<RowRange> rows;      ///< rows that changed owner, ascending
    std::vector<LeaseId> overtaken;  ///< leases that lost cells
  };

  /// Gives the band's samples to `owner`. If some of these samples are already stored in a row,
  /// the row is not changed, because the film cannot take a part of a node. A lease that loses a
  /// part of its samples in a row loses the whole row: the rest becomes free.
  Change assign(const Band& band, Owner owner);

  /// Frees the part of the band that the lease still owns.
  void give_back(const Band& band, LeaseId lease);

  /// Frees the stored samples of the band. A stored cell with more samples than the band is cut,
  /// and its other samples stay stored.
  void reopen(const Band& band);

  /// Returns the rows of the band in which none of its samples is stored, ascending.
  std::vector<RowRange> wanted(const Band& band) const;
  /// Returns true if a new lease of the band can own all of its wanted rows: some row of the band
  /// is wanted, and no lease owns any of the band's samples in a wanted row.
  bool adoptable(const Band& band) const;
  /// Returns true if the lease still owns a part of the band.
  bool holds(const Band& band, LeaseId lease) const;

  /// Returns the first free piece whose strip begins at `row` or below it in the image. A piece is
  /// a node and consecutive rows in which it is free. std::nullopt: no such strip has a free cell.
  std::optional<Band> free_from(std::uint32_t row) const;
  /// Returns the free piece that begins at `row`, which need not be the first row of a strip.
  /// std::nullopt: nothing of the row is free.
  std::optional<Band> free_at(std::uint32_t row) const;

  bool complete() const { return stored_ == total_; }
  bool any_free() const { return !with_free_.empty(); }
  /// free_samples() and stored_samples() return the number of free or stored samples of one column
  /// of pixels, summed over the rows.
  std::uint64_t free_samples() const { return free_; }
  std::uint64_t stored_samples() const { return stored_; }

  const SampleRange& pass() const { return pass_; }
  std::uint32_t height() const { return height_; }

  /// Calls `f(lease, band)` for each cell that a lease owns; `band` has the samples of the cell and
  /// the rows of its strip. Returns std::nullopt if strips and cells partition the pass and the
  /// counts are right, else a sentence that says what is wrong.
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
    std::vector<Cell> cells;  ///< in the order of their samples
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
