#pragma once

// A Ticker calls a function periodically, on a thread of its own, until the Ticker is destroyed.
// `render`, `submit` and `watch` use it to update their display.

#include <chrono>
#include <functional>
#include <thread>

#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class Ticker {
 public:
  /// Calls `tick` at once, and then again each time `interval` has passed since the last call
  /// returned.
  Ticker(std::chrono::milliseconds interval, std::function<void()> tick);
  /// Waits for a call in progress.
  ~Ticker();
  Ticker(const Ticker&) = delete;
  Ticker& operator=(const Ticker&) = delete;

 private:
  void run(std::chrono::milliseconds interval, const std::function<void()>& tick) EXCLUDES(mutex_);

  Mutex mutex_;
  CondVar changed_;
  bool stopping_ GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace bandsaw::coordinator
