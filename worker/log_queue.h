#pragma once

// A log sink from which the lines are taken that the coordinator has not got yet.

#include <spdlog/sinks/base_sink.h>

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace bandsaw::worker {

/// Bounded: while nobody takes them, the oldest lines go, and their number is told in their place.
class LogQueue final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  /// The oldest `most` lines at most, which are forgotten here. Any thread.
  std::vector<std::string> take(std::size_t most);
  /// The last lines that were taken are to be taken again: who had them has lost them. Any thread.
  void again();

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}

 private:
  static constexpr std::size_t kKept = 500;
  static constexpr std::size_t kTakenKept = 50;
  std::deque<std::string> lines_;  ///< under the base's lock, as all
  std::deque<std::string> taken_;  ///< the newest
  std::uint64_t lost_ = 0;
};

}  // namespace bandsaw::worker
