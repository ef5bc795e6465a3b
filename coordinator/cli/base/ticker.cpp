// A thread calls tick() at once and then after each interval, until the destructor ends it.

#include "coordinator/cli/base/ticker.h"

#include <utility>

namespace bandsaw::coordinator {

Ticker::Ticker(std::chrono::milliseconds interval, std::function<void()> tick)
    : thread_([this, interval, call = std::move(tick)] { run(interval, call); }) {}

Ticker::~Ticker() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void Ticker::run(std::chrono::milliseconds interval, const std::function<void()>& tick) {
  for (;;) {
    tick();
    const auto next = std::chrono::steady_clock::now() + interval;
    MutexLock lock(mutex_);
    while (!stopping_ && std::chrono::steady_clock::now() < next) {
      changed_.wait_for(mutex_, next - std::chrono::steady_clock::now());
    }
    if (stopping_) {
      return;
    }
  }
}

}  // namespace bandsaw::coordinator
