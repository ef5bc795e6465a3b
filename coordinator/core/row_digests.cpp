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

std::optional<std::uint64_t> RowDigests::of(const SampleRange& samples, std::uint32_t row) const {
  const auto of_node = known_.find(samples);
  if (of_node == known_.end()) {
    return std::nullopt;
  }
  const auto digest = of_node->second.find(row);
  return digest == of_node->second.end() ? std::nullopt : std::optional(digest->second);
}

void RowDigests::forget(const Band& band) {
  if (const auto of_node = known_.find(band.samples); of_node != known_.end()) {
    of_node->second.erase(of_node->second.lower_bound(band.rows.first),
                          of_node->second.lower_bound(band.rows.last));
  }
}

}  // namespace bandsaw::coordinator
