#pragma once

// A log sink that queues lines until they are sent to the coordinator.

#include <spdlog/sinks/base_sink.h>

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace bandsaw::worker {

/// A bounded queue: when it is full, the oldest lines are dropped, and a line with their number
/// takes their place.
class LogQueue final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  /// Removes and returns the oldest lines, at most `most`. Thread-safe.
  std::vector<std::string> take(std::size_t most);
  /// Puts the lines that were taken last (at most 50) back into the queue, because the coordinator
  /// lost them in a restart. Thread-safe.
  void again();

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}

 private:
  static constexpr std::size_t kKept = 500;      ///< lines
  static constexpr std::size_t kTakenKept = 50;  ///< lines; as many as one message has
  std::deque<std::string> lines_;  ///< protected by the base class's mutex, as are all members
  std::deque<std::string> taken_;  ///< the newest taken lines
  std::uint64_t lost_ = 0;         ///< lines dropped since the last take()
};

}  // namespace bandsaw::worker
