#pragma once

// std::mutex with annotations for clang's thread-safety analysis. (Debian's absl::Mutex is not
// instrumented for ThreadSanitizer, which then reports false races.) Programs for WebAssembly have
// one thread: there a lock does nothing, and there are no condition variables.

#if !defined(__wasm__)
#include <condition_variable>
#include <mutex>
#endif

#include "absl/base/thread_annotations.h"  // also included by gRPC; defines GUARDED_BY

// GUARDED_BY(m): a member may be accessed only while m is held. REQUIRES(m): the caller of a
// function holds m. EXCLUDES(m): the caller does not hold m. BANDSAW_TSA(x): an attribute, for
// clang only.
#if defined(__clang__)
#define BANDSAW_TSA(x) __attribute__((x))
#else
#define BANDSAW_TSA(x)
#endif
#ifndef GUARDED_BY
#define GUARDED_BY(x) BANDSAW_TSA(guarded_by(x))
#endif
#define REQUIRES(x) BANDSAW_TSA(requires_capability(x))
#define EXCLUDES(x) BANDSAW_TSA(locks_excluded(x))

namespace bandsaw {

#if defined(__wasm__)
class BANDSAW_TSA(capability("mutex")) Mutex {
 public:
  void lock() BANDSAW_TSA(acquire_capability()) {}
  void unlock() BANDSAW_TSA(release_capability()) {}
};
#else
class BANDSAW_TSA(capability("mutex")) Mutex {
 public:
  void lock() BANDSAW_TSA(acquire_capability()) { mutex_.lock(); }
  void unlock() BANDSAW_TSA(release_capability()) { mutex_.unlock(); }

 private:
  friend class CondVar;
  std::mutex mutex_;
};
#endif

/// Holds the mutex as long as the object exists.
class BANDSAW_TSA(scoped_lockable) MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) BANDSAW_TSA(acquire_capability(mutex)) : mutex_(mutex) {
    mutex_.lock();
  }
  ~MutexLock() BANDSAW_TSA(release_capability()) { mutex_.unlock(); }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

 private:
  Mutex& mutex_;
};

#if !defined(__wasm__)
/// Condition variable. The caller holds the mutex. Wake-ups can be spurious, so wait in a loop over
/// the condition.
class CondVar {
 public:
  void wait(Mutex& mutex) REQUIRES(mutex) {
    std::unique_lock<std::mutex> lock(mutex.mutex_, std::adopt_lock);
    condition_.wait(lock);
    lock.release();
  }
  /// Returns false if the time has passed.
  template <class Rep, class Period>
  bool wait_for(Mutex& mutex, std::chrono::duration<Rep, Period> time) REQUIRES(mutex) {
    std::unique_lock<std::mutex> lock(mutex.mutex_, std::adopt_lock);
    const bool woken = condition_.wait_for(lock, time) == std::cv_status::no_timeout;
    lock.release();
    return woken;
  }
  void notify_one() { condition_.notify_one(); }
  void notify_all() { condition_.notify_all(); }

 private:
  std::condition_variable condition_;
};
#endif

}  // namespace bandsaw
