#pragma once

// Records which worker rendered which rows, for display. For a job that is over, the records are
// stored beside its image (store/attribution_file.h).

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/job_view.h"
#include "coordinator/store/attribution_file.h"

namespace bandsaw::coordinator {

/// Attribution of the jobs that are not over. Not thread-safe.
class Attribution {
 public:
  /// Adds rows of a job. `process` identifies the worker process in all epochs (runs of the
  /// coordinator). `name` is the name of the worker. It is empty for a band that was read from
  /// disk, because the record on disk has no name. The name becomes known when the worker sends
  /// another band.
  void add(JobId job, const RowRange& rows, std::uint64_t process, const std::string& name);
  /// Returns the rendered rows with the names of their workers, from top to bottom. Adjacent rows
  /// of one worker are one entry.
  std::vector<RowsBy> of(JobId job) const;
  void forget(JobId job) { jobs_.erase(job); }

 private:
  /// Bounds the memory; names of further workers are empty.
  static constexpr std::size_t kMaxNames = 65'536;

  struct Piece {
    RowRange rows;
    std::uint64_t process = 0;  ///< the worker process that rendered the rows
  };
  /// Pieces that do not overlap, keyed by first row.
  using Rows = std::map<std::uint32_t, Piece>;
  std::map<JobId, Rows> jobs_;
  std::map<std::uint64_t, std::string> names_;  ///< by process
};

}  // namespace bandsaw::coordinator
