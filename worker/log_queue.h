#pragma once

// A log sink that queues lines until they are sent to the coordinator.

#include <spdlog/sinks/base_sink.h>

#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

namespace bandsaw::worker {

/// A bounded queue. When it is full, the oldest lines are dropped, and a line with their number
/// takes their place.
class LogQueue final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  /// Removes and returns the oldest lines, at most `most`. Thread-safe.
  std::vector<std::string> take(std::size_t most);
  /// To be called for each message of the coordinator except Welcome and Refused. The lines taken
  /// so far then count as arrived. Thread-safe.
  void arrived();
  /// To be called when the coordinator has accepted a new connection. Puts the lines taken since
  /// arrived() back into the queue. If the coordinator has `restarted`, puts all taken lines back.
  /// At most the last 50 lines are put back. If more lines were taken since arrived(), the earlier
  /// ones count as dropped. Thread-safe.
  void again(bool restarted);

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}

 private:
  static constexpr std::size_t kKept = 500;      ///< lines
  static constexpr std::size_t kTakenKept = 50;  ///< lines; as many as one message has
  std::deque<std::string> lines_;  ///< protected by the base class's mutex, as are all members
  std::deque<std::string> taken_;  ///< the newest taken lines
  std::uint64_t under_way_ = 0;    ///< lines taken since arrived()
  std::uint64_t lost_ = 0;         ///< lines dropped since the last take()
};

}  // namespace bandsaw::worker
