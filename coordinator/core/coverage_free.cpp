// What is free of a pass, and whether strips and cells are as they must be.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/core/coverage.h"

namespace bandsaw::coordinator {

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
      return absl::StrCat("a strip is short or not where free ones are found, at row ", first);
    }
    row = strip.last;
  }
  if (row != height_ || free != free_ || stored != stored_) {
    return "the rows or the counts of a pass are wrong";
  }
  return std::nullopt;
}

}  // namespace bandsaw::coordinator
