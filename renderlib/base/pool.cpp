// parallel_for() puts a range of indices into a list. Threads take one index after the other from
// the oldest range; the caller waits until the last index is done. If a call throws, its range is
// removed from the list, and the caller rethrows the exception when the running calls are done.

#include "renderlib/base/pool.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace bandsaw {

/// The indices of one call of parallel_for().
struct Pool::Range {
  std::int64_t next = 0;     // the first index that no thread has taken; guarded by Pool::mutex_
  std::int64_t running = 0;  // number of calls of `body` that run; guarded by Pool::mutex_
  std::int64_t count = 0;
  absl::FunctionRef<void(std::int64_t)> body;
  std::exception_ptr error;  // the first that `body` threw; guarded by Pool::mutex_
};

namespace {

/// Calls body(index) and returns the exception that it threw; null if it threw none.
std::exception_ptr call(absl::FunctionRef<void(std::int64_t)> body, std::int64_t index) {
  try {
    body(index);
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

}  // namespace

Pool::Pool(int threads) {
  for (int i = 0; i < std::max(1, threads); ++i) {
    threads_.emplace_back([this] { run(); });
  }
}

Pool::~Pool() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
  }
  work_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void Pool::parallel_for(std::int64_t count, absl::FunctionRef<void(std::int64_t)> body) {
  if (count <= 0) {
    return;
  }
  Range range{.count = count, .body = body, .error = nullptr};
  MutexLock lock(mutex_);
  ranges_.push_back(&range);
  work_.notify_all();
  while (range.next < range.count || range.running > 0) {
    done_.wait(mutex_);
  }
  if (range.error != nullptr) {
    std::rethrow_exception(std::move(range.error));
  }
}

std::uint64_t Pool::calls_done() const {
  MutexLock lock(mutex_);
  return calls_done_;
}

void Pool::run() {
  MutexLock lock(mutex_);
  while (true) {
    while (ranges_.empty() && !stopping_) {
      work_.wait(mutex_);
    }
    if (ranges_.empty()) {
      return;
    }
    Range& range = *ranges_.front();
    const std::int64_t index = range.next++;
    ++range.running;
    if (range.next == range.count) {
      ranges_.pop_front();
    }
    mutex_.unlock();
    std::exception_ptr error = call(range.body, index);
    mutex_.lock();
    ++calls_done_;
    if (error != nullptr && range.error == nullptr) {
      range.error = std::move(error);
      range.next = range.count;
      std::erase(ranges_, &range);
    }
    if (--range.running == 0 && range.next == range.count) {
      done_.notify_all();
    }
  }
}

}  // namespace bandsaw
