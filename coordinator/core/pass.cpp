// What is there of a pass, and who stored it.

#include <algorithm>
#include <numeric>

#include "coordinator/core/job.h"

namespace bandsaw::coordinator {

double Pass::share() const {
  return shares.empty() ? 1
                        : std::accumulate(shares.begin(), shares.end(), 0.0) /
                              static_cast<double>(shares.size());
}

void Pass::credit(std::uint64_t renderer, const Band& band, const std::vector<RowRange>& rows,
                  const Totals& totals) {
  Part& part = parts[renderer];
  for (const RowRange& range : rows) {
    part.bands.push_back({{band.samples, range}, range == rows.front() ? totals : Totals()});
  }
  part.totals.add(totals);
  stored.add(totals);
}

bool Pass::retract(std::uint64_t renderer) {
  const auto part = parts.find(renderer);
  if (part == parts.end()) {
    return false;
  }
  for (const StoredBand& one : part->second.bands) {
    coverage.reopen(one.band);
    digests.forget(one.band);
  }
  parts.erase(part);
  add_up();
  return true;
}

bool Pass::has_stored(const Band& band, std::uint64_t renderer) const {
  const auto part = parts.find(renderer);
  return part != parts.end() &&
         std::any_of(part->second.bands.begin(), part->second.bands.end(),
                     [&](const StoredBand& one) { return one.band == band; });
}

std::optional<Totals> Pass::lose(const Band& band, std::uint64_t renderer) {
  const auto part = parts.find(renderer);
  if (part == parts.end()) {
    return std::nullopt;
  }
  std::vector<StoredBand>& bands = part->second.bands;
  const auto lost = std::find_if(bands.begin(), bands.end(),
                                 [&](const StoredBand& one) { return one.band == band; });
  if (lost == bands.end()) {
    return std::nullopt;
  }
  const Totals totals = lost->totals;
  bands.erase(lost);
  coverage.reopen(band);
  digests.forget(band);
  part->second.totals = {};
  for (const StoredBand& one : bands) {
    part->second.totals.add(one.totals);
  }
  if (bands.empty()) {
    parts.erase(part);
  }
  add_up();
  return totals;
}

/// Counters hold the first of something, so one cannot be taken out of a sum.
void Pass::add_up() {
  stored = {};
  for (const auto& [id, part] : parts) {
    stored.add(part.totals);
  }
}

std::uint64_t Pass::renderer_of_row(const SampleRange& of, std::uint32_t row) const {
  for (const auto& [renderer, part] : parts) {
    for (const StoredBand& one : part.bands) {
      const RowRange& rows = one.band.rows;
      if (one.band.samples == of && rows.first <= row && row < rows.last) {
        return renderer;
      }
    }
  }
  return 0;
}

}  // namespace bandsaw::coordinator
