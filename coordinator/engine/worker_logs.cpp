// Keeps the last lines of each worker's log. If all logs together become too large, the log of the
// worker that has been silent for the longest time is dropped.

#include "coordinator/engine/worker_logs.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::size_t kNamesInError = 20;  // maximum number of workers in an error message

/// Memory of a line besides its text.
constexpr std::size_t kLineOverhead = sizeof(std::string);

}  // namespace

void WorkerLogs::drop_oldest_line(Log& log) {
  const std::size_t bytes = log.lines.front().size() + kLineOverhead;
  log.lines.pop_front();
  log.bytes -= bytes;
  bytes_ -= bytes;
}

void WorkerLogs::add(const std::string& worker, std::vector<std::string> lines) {
  Log& log = logs_[worker];
  log.added_at = ++calls_;
  for (std::string& line : lines) {
    log.bytes += line.size() + kLineOverhead;
    bytes_ += line.size() + kLineOverhead;
    log.lines.push_back(std::move(line));
    if (log.lines.size() > max_lines_) {
      drop_oldest_line(log);
    }
  }
  while (bytes_ > max_bytes_ && logs_.size() > 1) {
    const auto silent = std::min_element(
        logs_.begin(), logs_.end(),
        [](const auto& a, const auto& b) { return a.second.added_at < b.second.added_at; });
    bytes_ -= silent->second.bytes;
    logs_.erase(silent);
  }
}

absl::StatusOr<std::vector<std::string>> WorkerLogs::of(const std::string& worker) const {
  if (const auto found = logs_.find(worker); found != logs_.end()) {
    return std::vector<std::string>(found->second.lines.begin(), found->second.lines.end());
  }
  std::vector<std::string> names;
  for (const auto& [name, log] : logs_) {
    if (names.size() == kNamesInError) {
      names.push_back("…");
      break;
    }
    names.push_back(name);
  }
  return absl::NotFoundError(absl::StrCat(
      "no worker '", worker, "' has sent lines of its log; ",
      names.empty() ? "no other worker has either"
                    : absl::StrCat("these workers have: ", absl::StrJoin(names, ", "))));
}

}  // namespace bandsaw::coordinator
