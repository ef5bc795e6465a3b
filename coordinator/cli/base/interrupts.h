#pragma once

// Handles SIGINT, SIGTERM and SIGHUP without signal handlers: the signals are blocked in all
// threads and read by one thread.

#include <functional>
#include <thread>

#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// MUST be constructed first in main, before any other thread, because threads inherit the signal
/// mask. Without a listener, a signal ends the process at once with status 130. A second signal
/// always does, except a second SIGHUP.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  /// While it exists, the first signal calls `first` on the reading thread instead of ending the
  /// process. If there are several listeners, only the newest is called. `first` MUST NOT call
  /// Interrupts.
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

  /// Waits for a signal; returns at once if one has already been received with a listener.
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
