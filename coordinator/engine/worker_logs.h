#pragma once

// The last lines of each worker's log, as the worker has sent them. The number of lines of each
// worker is limited, and so is the number of bytes of all lines together.

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// Not thread-safe.
class WorkerLogs {
 public:
  /// Limits: lines per worker, and bytes in total.
  WorkerLogs(std::size_t max_lines, std::size_t max_bytes)
      : max_lines_(max_lines), max_bytes_(max_bytes) {}

  /// Adds lines. Beyond `max_lines`, drops the worker's oldest lines. Beyond `max_bytes`, drops
  /// the whole logs of the workers that have sent nothing for the longest time.
  void add(const std::string& worker, std::vector<std::string> lines);
  /// Returns the lines, oldest first. NOT_FOUND: there are no lines of a worker of this name; the
  /// message lists the workers that have sent lines.
  absl::StatusOr<std::vector<std::string>> of(const std::string& worker) const;

 private:
  struct Log {
    std::deque<std::string> lines;
    std::size_t bytes = 0;
    std::uint64_t added_at = 0;  ///< value of calls_ at the last add
  };
  void drop_oldest_line(Log& log);

  std::size_t max_lines_;
  std::size_t max_bytes_;
  std::map<std::string, Log> logs_;
  std::size_t bytes_ = 0;
  std::uint64_t calls_ = 0;  ///< number of calls of add
};

}  // namespace bandsaw::coordinator
