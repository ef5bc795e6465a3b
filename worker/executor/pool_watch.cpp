// Once in each interval, a thread compares the number of calls that the pool has completed with the
// number at the last look.

#include "worker/executor/pool_watch.h"

#include <utility>

namespace bandsaw::worker {

PoolWatch::PoolWatch(const Pool& pool, std::chrono::milliseconds interval,
                     std::function<void()> advanced)
    : pool_(pool),
      interval_(interval),
      advanced_(std::move(advanced)),
      seen_(pool.calls_done()),
      thread_([this] { run(); }) {}

PoolWatch::~PoolWatch() {
  {
    MutexLock lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void PoolWatch::run() {
  MutexLock lock(mutex_);
  while (!over_) {
    changed_.wait_for(mutex_, interval_);
    if (const std::uint64_t done = pool_.calls_done(); !over_ && done != seen_) {
      seen_ = done;
      advanced_();
    }
  }
}

}  // namespace bandsaw::worker
