#include "coordinator/core/row_digests.h"

namespace bandsaw::coordinator {

void RowDigests::keep(const Band& band, const std::vector<RowRange>& rows,
                      const std::vector<std::uint64_t>& digests) {
  if (rows.empty()) {
    return;
  }
  auto& of_node = known_[band.samples];
  for (const RowRange& range : rows) {
    for (std::uint32_t row = range.first; row < range.last; ++row) {
      of_node.insert_or_assign(row, digests[row - band.rows.first]);
    }
  }
}

std::optional<std::uint32_t> RowDigests::first_difference(
    const Band& band, const std::vector<std::uint64_t>& digests) const {
  const auto of_node = known_.find(band.samples);
  if (of_node == known_.end()) {
    return std::nullopt;
  }
  for (auto it = of_node->second.lower_bound(band.rows.first);
       it != of_node->second.end() && it->first < band.rows.last; ++it) {
    if (it->second != digests[it->first - band.rows.first]) {
      return it->first;
    }
  }
  return std::nullopt;
}

}  // namespace bandsaw::coordinator
