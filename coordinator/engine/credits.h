#pragma once

// Who rendered which rows of which job that is at work, for people to look at. When a job is over
// they lie beside its image (store/credits_file.h).

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/ids.h"
#include "coordinator/store/credits_file.h"

namespace bandsaw::coordinator {

/// Of jobs at work. Used by one thread.
class Credits {
 public:
  /// `renderer` names the worker in all lives of the coordinator. `name` may be empty: what a band
  /// on disk does not say is known again once the worker brings the next.
  void add(JobId job, const RowRange& rows, std::uint64_t renderer, const std::string& name);
  /// By row, without those that nobody rendered; neighbours of one worker are one.
  std::vector<RowsBy> of(JobId job) const;
  void forget(JobId job) { jobs_.erase(job); }

 private:
  static constexpr std::size_t kMostNames = 65'536;

  struct Piece {
    RowRange rows;
    std::uint64_t renderer = 0;
  };
  /// Disjoint, by first row.
  using Rows = std::map<std::uint32_t, Piece>;
  std::map<JobId, Rows> jobs_;
  std::map<std::uint64_t, std::string> names_;  ///< by renderer
};

}  // namespace bandsaw::coordinator
