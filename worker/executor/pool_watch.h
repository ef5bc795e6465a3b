#pragma once

// Reports that a pool of threads makes progress, for a function that waits for the pool and cannot
// report the progress itself. The worker uses PoolWatch while BVHs are built. Building may take
// minutes, and if the coordinator hears of no progress, it gives the band to another worker.

#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>

#include "renderlib/base/mutex.h"
#include "renderlib/base/pool.h"

namespace bandsaw::worker {

/// As long as the object exists, a thread of its own looks at the pool once in each interval. If
/// the pool has completed calls (Pool::calls_done) since the last look, or since the object was
/// made, the thread calls `advanced`. If the pool hangs, `advanced` is not called.
class PoolWatch {
 public:
  /// `pool` MUST outlive the object.
  PoolWatch(const Pool& pool, std::chrono::milliseconds interval, std::function<void()> advanced);
  /// No call of `advanced` begins afterwards, and a running one has returned.
  ~PoolWatch();
  PoolWatch(const PoolWatch&) = delete;
  PoolWatch& operator=(const PoolWatch&) = delete;

 private:
  void run() EXCLUDES(mutex_);

  const Pool& pool_;
  const std::chrono::milliseconds interval_;
  const std::function<void()> advanced_;
  std::uint64_t seen_;  ///< Pool::calls_done at the last look
  Mutex mutex_;
  CondVar changed_;
  bool over_ GUARDED_BY(mutex_) = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace bandsaw::worker
