// A pass is a range of samples of the whole image. It keeps, for each worker process, the bands
// (ranges of rows and samples of the pass) that this process stored, so that all of them can be
// taken back if the process was wrong.

#include "coordinator/scheduler/model/pass.h"

#include <algorithm>
#include <numeric>

namespace bandsaw::coordinator {

void RowDigests::keep(const Band& band, const std::vector<RowRange>& rows,
                      const std::vector<std::uint64_t>& digests) {
  if (rows.empty()) {
    return;
  }
  auto& by_row = known_[band.samples];
  for (const RowRange& range : rows) {
    for (std::uint32_t row = range.first; row < range.last; ++row) {
      by_row.insert_or_assign(row, digests[row - band.rows.first]);
    }
  }
}

std::optional<std::uint32_t> RowDigests::first_difference(
    const Band& band, const std::vector<std::uint64_t>& digests) const {
  const auto by_row = known_.find(band.samples);
  if (by_row == known_.end()) {
    return std::nullopt;
  }
  for (auto it = by_row->second.lower_bound(band.rows.first);
       it != by_row->second.end() && it->first < band.rows.last; ++it) {
    if (it->second != digests[it->first - band.rows.first]) {
      return it->first;
    }
  }
  return std::nullopt;
}

std::optional<std::uint64_t> RowDigests::of(const SampleRange& samples, std::uint32_t row) const {
  const auto by_row = known_.find(samples);
  if (by_row == known_.end()) {
    return std::nullopt;
  }
  const auto digest = by_row->second.find(row);
  return digest == by_row->second.end() ? std::nullopt : std::optional(digest->second);
}

void RowDigests::forget(const Band& band) {
  if (const auto by_row = known_.find(band.samples); by_row != known_.end()) {
    by_row->second.erase(by_row->second.lower_bound(band.rows.first),
                         by_row->second.lower_bound(band.rows.last));
  }
}

double Pass::mean_share() const {
  return tile_row_shares.empty()
             ? 1
             : std::accumulate(tile_row_shares.begin(), tile_row_shares.end(), 0.0) /
                   static_cast<double>(tile_row_shares.size());
}

void Pass::add_stored(WorkerProcessId process, const Band& band, const std::vector<RowRange>& rows,
                      const Totals& totals) {
  Part& part = parts[process];
  for (const RowRange& range : rows) {
    part.bands.push_back({{band.samples, range}, range == rows.front() ? totals : Totals()});
  }
  part.totals.add(totals);
  stored.add(totals);
}

bool Pass::retract(WorkerProcessId process) {
  const auto part = parts.find(process);
  if (part == parts.end()) {
    return false;
  }
  for (const StoredBand& one : part->second.bands) {
    coverage.reopen(one.band);
    digests.forget(one.band);
  }
  parts.erase(part);
  recompute_totals();
  return true;
}

bool Pass::has_stored(const Band& band, WorkerProcessId process) const {
  const auto part = parts.find(process);
  return part != parts.end() &&
         std::any_of(part->second.bands.begin(), part->second.bands.end(),
                     [&](const StoredBand& one) { return one.band == band; });
}

std::optional<Totals> Pass::remove_stored(const Band& band, WorkerProcessId process) {
  const auto part = parts.find(process);
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
  recompute_totals();
  return totals;
}

/// Adds all parts up again. The removed part cannot be subtracted: Counters holds the location of
/// one bad sample only, the first. If that one lies in the removed part, the first bad sample of
/// the other parts is not known without them.
void Pass::recompute_totals() {
  stored = {};
  for (const auto& [id, part] : parts) {
    stored.add(part.totals);
  }
}

WorkerProcessId Pass::process_of_row(const SampleRange& wanted, std::uint32_t row) const {
  for (const auto& [process, part] : parts) {
    for (const StoredBand& one : part.bands) {
      const RowRange& rows = one.band.rows;
      if (one.band.samples == wanted && rows.first <= row && row < rows.last) {
        return process;
      }
    }
  }
  return 0;
}

}  // namespace bandsaw::coordinator
