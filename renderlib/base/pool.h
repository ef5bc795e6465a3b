#pragma once

// Thread pool that processes index ranges. Several callers may run ranges at the same time: a free
// thread takes its next index from the oldest range that has one left. So when the last indices of
// one band (a unit of rendering work) are running, free threads begin the next band. Programs for
// WebAssembly have one thread, which does the work itself.

#include <cstdint>
#include <deque>
#include <thread>
#include <vector>

#include "absl/functional/function_ref.h"
#include "renderlib/base/mutex.h"

namespace bandsaw {

#if defined(__wasm__)
class Pool {
 public:
  explicit Pool(int) {}
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  int threads() const { return 1; }
  void parallel_for(std::int64_t count, absl::FunctionRef<void(std::int64_t)> body) {
    for (std::int64_t i = 0; i < count; ++i) {
      body(i);
    }
  }
};
#else
class Pool {
 public:
  /// `threads` (>= 1) is the number of threads of the pool; callers of parallel_for() do no work.
  explicit Pool(int threads);
  /// Every parallel_for() MUST have returned.
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  int threads() const { return static_cast<int>(threads_.size()); }

  /// Calls body(i) once for each i in [0, count), in any order, from the pool's threads; returns
  /// when all calls have returned. If a call throws, no further calls begin; when the running ones
  /// have returned, the first exception is rethrown. MUST NOT be called from within a body.
  void parallel_for(std::int64_t count, absl::FunctionRef<void(std::int64_t)> body)
      EXCLUDES(mutex_);
  /// Returns the number of calls of bodies that have returned since the pool was made.
  std::uint64_t calls_done() const EXCLUDES(mutex_);

 private:
  struct Range;
  /// Runs in each thread until the pool is destroyed.
  void run() EXCLUDES(mutex_);

  mutable Mutex mutex_;
  CondVar work_;  ///< a range was added, or the pool stops
  CondVar done_;  ///< a range was completed
  /// The ranges that have indices left, oldest first. Each is a local variable of a parallel_for()
  /// that has not returned.
  std::deque<Range*> ranges_ GUARDED_BY(mutex_);
  std::uint64_t calls_done_ GUARDED_BY(mutex_) = 0;
  bool stopping_ GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};
#endif

}  // namespace bandsaw
