// A sink of spdlog that keeps lines until they are sent. A coordinator that restarts may lose lines
// that it has received; again() puts the last ones back into the queue.

#include "worker/log_queue.h"

#include <algorithm>

#include "absl/strings/str_cat.h"

namespace bandsaw::worker {

void LogQueue::sink_it_(const spdlog::details::log_msg& message) {
  spdlog::memory_buf_t text;
  formatter_->format(message, text);
  lines_.emplace_back(text.data(), text.size());
  if (lines_.size() > kKept) {
    lines_.pop_front();
    ++lost_;
  }
}

std::vector<std::string> LogQueue::take(std::size_t most) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> taken;
  if (lost_ > 0 && most > 0) {
    taken.push_back(absl::StrCat(lost_, " lines were not sent in time"));
    lost_ = 0;
  }
  while (taken.size() < most && !lines_.empty()) {
    taken.push_back(lines_.front());
    taken_.push_back(std::move(lines_.front()));
    lines_.pop_front();
    if (taken_.size() > kTakenKept) {
      taken_.pop_front();
    }
  }
  return taken;
}

void LogQueue::again() {
  const std::lock_guard<std::mutex> lock(mutex_);
  lines_.insert(lines_.begin(), taken_.begin(), taken_.end());
  taken_.clear();
}

}  // namespace bandsaw::worker
