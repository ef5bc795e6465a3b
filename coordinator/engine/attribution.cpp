// Keeps for each job which worker process rendered each row last. Rows are stored as pieces (ranges
// of rows of one process) that do not overlap. add() cuts the pieces that overlap the new rows.

#include "coordinator/engine/attribution.h"

#include <iterator>

namespace bandsaw::coordinator {

void Attribution::add(JobId job, const RowRange& rows, std::uint64_t process,
                      const std::string& name) {
  if (!name.empty() && (names_.size() < kMaxNames || names_.contains(process))) {
    names_[process] = name;
  }
  Rows& all = jobs_[job];
  auto next = all.lower_bound(rows.first);
  if (next != all.begin() && std::prev(next)->second.rows.last > rows.first) {
    --next;
  }
  while (next != all.end() && next->second.rows.first < rows.last) {
    const Piece old = next->second;
    next = all.erase(next);
    if (old.rows.first < rows.first) {
      all[old.rows.first] = {{old.rows.first, rows.first}, old.process};
    }
    if (old.rows.last > rows.last) {
      all[rows.last] = {{rows.last, old.rows.last}, old.process};
    }
  }
  all[rows.first] = {rows, process};
}

std::vector<RowsBy> Attribution::of(JobId job) const {
  std::vector<RowsBy> out;
  const auto found = jobs_.find(job);
  if (found == jobs_.end()) {
    return out;
  }
  for (const auto& [first, one] : found->second) {
    const auto name = names_.find(one.process);
    const std::string worker = name == names_.end() ? "" : name->second;
    if (!out.empty() && out.back().rows.last == first && out.back().worker == worker) {
      out.back().rows.last = one.rows.last;
    } else {
      out.push_back({one.rows, worker});
    }
  }
  return out;
}

}  // namespace bandsaw::coordinator
