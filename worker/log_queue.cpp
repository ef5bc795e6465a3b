// A sink of spdlog that keeps lines until they are sent. Sent lines may be lost: a connection may
// break before they arrive, and a coordinator that restarts may lose lines that it has received.
// again() puts the last sent lines back into the queue.

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
    lines_.push_front(absl::StrCat(lost_, " lines were not sent in time"));
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
  under_way_ += taken.size();
  return taken;
}

void LogQueue::arrived() {
  const std::lock_guard<std::mutex> lock(mutex_);
  under_way_ = 0;
}

void LogQueue::again(bool restarted) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::size_t count =
      restarted ? taken_.size() : std::min<std::size_t>(under_way_, taken_.size());
  const auto first = taken_.end() - static_cast<std::ptrdiff_t>(count);
  lines_.insert(lines_.begin(), first, taken_.end());
  taken_.erase(first, taken_.end());
  lost_ += under_way_ - std::min<std::uint64_t>(under_way_, count);
  under_way_ = 0;
}

}  // namespace bandsaw::worker
