#pragma once

// SIGINT, SIGTERM and SIGHUP without signal handlers: they are blocked in every thread and read by
// one.

#include <functional>
#include <thread>

#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// Made first thing in main, before any other thread: threads inherit the blocked signals. While
/// nobody listens a signal ends the process at once with status 130; a second one does so
/// always, but for a second SIGHUP.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  /// While it lives, the first signal calls `first` on the reading thread instead; of several the
  /// newest.
  class Listener {
   public:
    Listener(Interrupts& interrupts, std::function<void()> first);
    ~Listener();
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

   private:
    Interrupts& interrupts_;
    std::function<void()> before_;
  };

  /// Waits for a signal; returns at once when one has come while somebody listened.
  void wait() EXCLUDES(mutex_);
  bool seen() const EXCLUDES(mutex_);

 private:
  void read() EXCLUDES(mutex_);
  void took_signal(int signal) EXCLUDES(mutex_);

  mutable Mutex mutex_;
  CondVar changed_;
  std::function<void()> first_ GUARDED_BY(mutex_);
  bool seen_ GUARDED_BY(mutex_) = false;
  int signals_ = -1;  // signalfd
  int stop_ = -1;     // eventfd: ends the reading thread
  std::thread reader_;
};

}  // namespace bandsaw::coordinator
