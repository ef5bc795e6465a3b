// The rows of a pass (a range of samples of the whole image) are cut into strips, and the samples
// of each strip into cells. Each cell is a node, that is, an aligned power-of-two number of blocks
// of 8 samples. It is owned by one lease, or free, or stored. A change cuts strips at the first and
// the last row of a band (a range of rows and samples), changes the cells of the strips in between,
// merges cells and strips that have become equal, and keeps the counts of samples.

#include "coordinator/scheduler/model/coverage.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/check.h"

namespace bandsaw::coordinator {
namespace {

bool overlap(const SampleRange& a, const SampleRange& b) {
  return a.first < b.last && b.first < a.last;
}

bool contains(const SampleRange& outer, const SampleRange& inner) {
  return outer.first <= inner.first && inner.last <= outer.last;
}

/// Returns true if the nodes are the two halves of one node.
bool siblings(const SampleRange& left, const SampleRange& right) {
  return left.last == right.first && left.blocks() == right.blocks() &&
         left.first_block() % (2 * left.blocks()) == 0;
}

/// Appends `more` to ascending ranges of rows. Extends the last range if `more` begins at its end.
void append_rows(std::vector<RowRange>& rows, const RowRange& more) {
  if (!rows.empty() && rows.back().last == more.first) {
    rows.back().last = more.last;
  } else {
    rows.push_back(more);
  }
}

}  // namespace

Coverage::Coverage(const SampleRange& pass, std::uint32_t height)
    : pass_(pass), height_(height), total_(pass.samples() * height) {
  const auto [it, added] = strips_.emplace(0, Strip{height, {Cell{pass, kFree}}});
  count(it->first, it->second);
}

/// Adds a strip to the counts of samples and to the strips with a free cell.
void Coverage::count(std::uint32_t first, const Strip& strip) {
  bool any = false;
  for (const Cell& cell : strip.cells) {
    const std::uint64_t samples = cell.node.samples() * (strip.last - first);
    free_ += cell.owner == kFree ? samples : 0;
    stored_ += cell.owner == kStored ? samples : 0;
    any = any || cell.owner == kFree;
  }
  if (any) {
    with_free_.insert(first);
  }
}

/// Reverses count().
void Coverage::uncount(std::uint32_t first, const Strip& strip) {
  for (const Cell& cell : strip.cells) {
    const std::uint64_t samples = cell.node.samples() * (strip.last - first);
    free_ -= cell.owner == kFree ? samples : 0;
    stored_ -= cell.owner == kStored ? samples : 0;
  }
  with_free_.erase(first);
}

/// Returns the strip that contains `row`.
Coverage::Strips::const_iterator Coverage::strip_at(std::uint32_t row) const {
  return std::prev(strips_.upper_bound(row));
}

/// Makes `row` the first row of a strip. No effect if `row` is the end of the image.
void Coverage::cut_at(std::uint32_t row) {
  if (row == 0 || row >= height_ || strips_.contains(row)) {
    return;
  }
  const auto above = std::prev(strips_.upper_bound(row));
  Strip below{above->second.last, above->second.cells};
  above->second.last = row;
  if (with_free_.contains(above->first)) {
    with_free_.insert(row);
  }
  strips_.emplace_hint(std::next(above), row, std::move(below));
}

/// Joins adjacent strips with equal cells, from the strip before `rows` to the end of `rows`.
void Coverage::join(const RowRange& rows) {
  auto it = strips_.lower_bound(rows.first);
  if (it != strips_.begin()) {
    --it;
  }
  for (auto next = std::next(it); next != strips_.end() && it->first < rows.last;
       next = std::next(it)) {
    if (next->second.cells == it->second.cells) {
      it->second.last = next->second.last;
      with_free_.erase(next->first);
      strips_.erase(next);
    } else {
      it = next;
    }
  }
}

/// Returns true if some sample of `node` is stored in the strip.
bool Coverage::stored_in(const Strip& strip, const SampleRange& node) {
  return std::any_of(strip.cells.begin(), strip.cells.end(), [&](const Cell& cell) {
    return cell.owner == kStored && overlap(cell.node, node);
  });
}

/// Merges sibling cells that are both free or both stored.
void Coverage::merge_siblings(Strip& strip) {
  std::vector<Cell> merged;
  for (Cell cell : strip.cells) {
    while (!merged.empty() && merged.back().owner == cell.owner &&
           (cell.owner == kFree || cell.owner == kStored) &&
           siblings(merged.back().node, cell.node)) {
      cell.node.first = merged.back().node.first;
      merged.pop_back();
    }
    merged.push_back(cell);
  }
  strip.cells = std::move(merged);
}

/// Gives `node` of a strip to `owner`. The rest of a cell that overlaps `node` becomes free; leases
/// that lose a cell are appended to `lost`.
void Coverage::put(Strip& strip, const SampleRange& node, Owner owner, std::vector<LeaseId>& lost) {
  std::vector<Cell> cells;
  for (const Cell& cell : strip.cells) {
    if (!overlap(cell.node, node)) {
      cells.push_back(cell);
      continue;
    }
    if (cell.owner != kFree && cell.owner != owner) {
      lost.push_back(cell.owner);
    }
    SampleRange rest = cell.node;
    while (contains(rest, node) && rest != node) {
      const Halves halves = split(rest);
      const bool left = contains(halves.left, node);
      cells.push_back({left ? halves.right : halves.left, kFree});
      rest = left ? halves.left : halves.right;
    }
  }
  cells.push_back({node, owner});
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.node < b.node; });
  strip.cells = std::move(cells);
  merge_siblings(strip);
}

Coverage::Change Coverage::assign(const Band& band, Owner owner) {
  BANDSAW_CHECK(contains(pass_, band.samples) && band.rows.last <= height_ &&
                    band.rows.first < band.rows.last,
                "bands are checked against their pass before");
  Change change;
  cut_at(band.rows.first);
  cut_at(band.rows.last);
  for (auto it = strips_.find(band.rows.first); it != strips_.end() && it->first < band.rows.last;
       ++it) {
    if (stored_in(it->second, band.samples)) {
      continue;
    }
    uncount(it->first, it->second);
    put(it->second, band.samples, owner, change.overtaken);
    count(it->first, it->second);
    append_rows(change.rows, {it->first, it->second.last});
  }
  join(band.rows);
  std::sort(change.overtaken.begin(), change.overtaken.end());
  change.overtaken.erase(std::unique(change.overtaken.begin(), change.overtaken.end()),
                         change.overtaken.end());
  return change;
}

void Coverage::give_back(const Band& band, LeaseId lease) {
  cut_at(band.rows.first);
  cut_at(band.rows.last);
  for (auto it = strips_.find(band.rows.first); it != strips_.end() && it->first < band.rows.last;
       ++it) {
    uncount(it->first, it->second);
    for (Cell& cell : it->second.cells) {
      cell.owner = cell.owner == lease ? kFree : cell.owner;
    }
    merge_siblings(it->second);
    count(it->first, it->second);
  }
  join(band.rows);
}

/// Frees the parts of stored cells that lie in `node`; the rest of such a cell stays stored.
void Coverage::open(Strip& strip, const SampleRange& node) {
  std::vector<Cell> cells;
  for (Cell cell : strip.cells) {
    if (cell.owner == kStored && overlap(cell.node, node)) {
      while (contains(cell.node, node) && cell.node != node) {
        const Halves halves = split(cell.node);
        const bool left = contains(halves.left, node);
        cells.push_back({left ? halves.right : halves.left, kStored});
        cell.node = left ? halves.left : halves.right;
      }
      cell.owner = kFree;
    }
    cells.push_back(cell);
  }
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.node < b.node; });
  strip.cells = std::move(cells);
  merge_siblings(strip);
}

void Coverage::reopen(const Band& band) {
  cut_at(band.rows.first);
  cut_at(band.rows.last);
  for (auto it = strips_.find(band.rows.first); it != strips_.end() && it->first < band.rows.last;
       ++it) {
    uncount(it->first, it->second);
    open(it->second, band.samples);
    count(it->first, it->second);
  }
  join(band.rows);
}

std::vector<RowRange> Coverage::wanted(const Band& band) const {
  std::vector<RowRange> rows;
  for (auto it = strip_at(band.rows.first); it != strips_.end() && it->first < band.rows.last;
       ++it) {
    if (!stored_in(it->second, band.samples)) {
      append_rows(
          rows, {std::max(it->first, band.rows.first), std::min(it->second.last, band.rows.last)});
    }
  }
  return rows;
}

bool Coverage::adoptable(const Band& band) const {
  bool any = false;
  for (auto it = strip_at(band.rows.first); it != strips_.end() && it->first < band.rows.last;
       ++it) {
    if (stored_in(it->second, band.samples)) {
      continue;
    }
    any = true;
    for (const Cell& cell : it->second.cells) {
      if (overlap(cell.node, band.samples) && cell.owner != kFree) {
        return false;
      }
    }
  }
  return any;
}

bool Coverage::holds(const Band& band, LeaseId lease) const {
  for (auto it = strip_at(band.rows.first); it != strips_.end() && it->first < band.rows.last;
       ++it) {
    for (const Cell& cell : it->second.cells) {
      if (cell.owner == lease) {
        return true;
      }
    }
  }
  return false;
}

/// Returns the samples of the first free cell of the strip; std::nullopt: no cell is free.
std::optional<SampleRange> Coverage::free_in(const Strip& strip) {
  const auto cell = std::find_if(strip.cells.begin(), strip.cells.end(),
                                 [](const Cell& c) { return c.owner == kFree; });
  return cell == strip.cells.end() ? std::nullopt : std::optional(cell->node);
}

std::optional<Band> Coverage::free_from(std::uint32_t row) const {
  const auto key = with_free_.lower_bound(row);
  if (key == with_free_.end()) {
    return std::nullopt;
  }
  const Strip& strip = strips_.at(*key);
  return Band{*free_in(strip), {*key, strip.last}};
}

std::optional<Band> Coverage::free_at(std::uint32_t row) const {
  const Strip& strip = strip_at(row)->second;
  const auto node = free_in(strip);
  return node ? std::optional(Band{*node, {row, strip.last}}) : std::nullopt;
}

/// Returns std::nullopt if strips and cells partition the pass and the counts are right, else a
/// sentence that says what is wrong.
std::optional<std::string> Coverage::broken_partition() const {
  std::uint32_t row = 0;
  std::uint64_t free = 0;
  std::uint64_t stored = 0;
  for (const auto& [first, strip] : strips_) {
    if (first != row || strip.last <= first) {
      return absl::StrCat("strips do not follow each other at row ", first);
    }
    std::uint64_t sample = pass_.first;
    bool any = false;
    for (const Cell& cell : strip.cells) {
      if (cell.node.first != sample || !is_node(cell.node)) {
        return absl::StrCat("cells do not partition the pass at row ", first);
      }
      sample = cell.node.last;
      free += cell.owner == kFree ? cell.node.samples() * (strip.last - first) : 0;
      stored += cell.owner == kStored ? cell.node.samples() * (strip.last - first) : 0;
      any = any || cell.owner == kFree;
    }
    if (sample != pass_.last || any != with_free_.contains(first)) {
      return absl::StrCat("samples are missing, or with_free_ is wrong, for the strip at row ",
                          first);
    }
    row = strip.last;
  }
  if (row != height_ || free != free_ || stored != stored_) {
    return "the rows or the counts of a pass are wrong";
  }
  return std::nullopt;
}

}  // namespace bandsaw::coordinator
