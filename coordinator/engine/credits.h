#pragma once

// Who rendered which rows of which job, for people to look at.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// Rows that one worker rendered last.
struct RowsBy {
  RowRange rows;
  std::string worker;  ///< its name; empty: not known, as after a restart
  friend bool operator==(const RowsBy&, const RowsBy&) = default;
};

/// Keeps the newest kMostJobs jobs that it heard of. Used by one thread.
class Credits {
 public:
  static constexpr std::size_t kMostJobs = 200;

  void add(JobId job, const RowRange& rows, const std::string& worker);
  /// By row, without those that nobody rendered; neighbours of one worker are one.
  std::vector<RowsBy> of(JobId job) const;

 private:
  /// Disjoint, by first row.
  using Rows = std::map<std::uint32_t, RowsBy>;
  std::map<JobId, Rows> jobs_;
};

}  // namespace bandsaw::coordinator
