#pragma once

// The last lines of each worker's log, as far as they were sent: bounded a worker, and in all.

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// Used by one thread.
class WorkerLogs {
 public:
  WorkerLogs(std::size_t most_lines, std::size_t most_bytes)
      : most_lines_(most_lines), most_bytes_(most_bytes) {}

  /// Past the lines of one worker its oldest go; past the bytes of all, the log that was silent for
  /// the longest.
  void add(const std::string& worker, std::vector<std::string> lines);
  /// Oldest first. NOT_FOUND: nothing was heard of it; says of whom something was.
  absl::StatusOr<std::vector<std::string>> of(const std::string& worker) const;

 private:
  struct Log {
    std::deque<std::string> lines;
    std::size_t bytes = 0;
    std::uint64_t added_at = 0;  ///< counts calls
  };
  void drop_oldest_line(Log& log);

  std::size_t most_lines_;
  std::size_t most_bytes_;
  std::map<std::string, Log> logs_;
  std::size_t bytes_ = 0;
  std::uint64_t calls_ = 0;
};

}  // namespace bandsaw::coordinator
