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
  std::string worker;  ///< its name; empty: not known
  friend bool operator==(const RowsBy&, const RowsBy&) = default;
};

/// Keeps the newest kMostJobs jobs that it heard of. Used by one thread.
class Credits {
 public:
  static constexpr std::size_t kMostJobs = 200;

  /// `renderer` names the worker in all lives of the coordinator. `name` may be empty: what a band
  /// on disk does not say is known again once the worker brings the next.
  void add(JobId job, const RowRange& rows, std::uint64_t renderer, const std::string& name);
  /// By row, without those that nobody rendered; neighbours of one worker are one.
  std::vector<RowsBy> of(JobId job) const;

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
