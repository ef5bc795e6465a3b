#pragma once

// Receives SIGINT, SIGTERM and SIGHUP without signal handlers: the signals are blocked in all
// threads, and one thread reads them. A command makes a Listener to say what a signal does.

#include <functional>
#include <thread>

#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// An object MUST be constructed in main before any other thread starts, because threads inherit
/// the signal mask. Without a Listener, a signal ends the process at once with status 130. With a
/// Listener, the first signal calls the Listener's function. After that, SIGINT or SIGTERM ends the
/// process, and SIGHUP is ignored.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  /// While a Listener exists, the first signal of the process calls `first` on the reading thread
  /// instead of ending the process. If there are several Listeners, only the newest one is called.
  /// `first` MUST NOT call functions of Interrupts or Listener, because the mutex of Interrupts is
  /// locked during the call. A Listener MUST be destroyed before every older Listener.
  class Listener {
   public:
    Listener(Interrupts& interrupts, std::function<void()> first);
    ~Listener();
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

   private:
    Interrupts& interrupts_;
    std::function<void()> before_;  ///< function of the Listener before this one; may be empty
  };

  /// Waits until a Listener has been called; returns at once if one was called before.
  void wait() EXCLUDES(mutex_);
  /// Returns true if a Listener has been called.
  bool seen() const EXCLUDES(mutex_);

 private:
  /// Reads signals until the destructor ends the thread.
  void read() EXCLUDES(mutex_);
  /// Handles one signal: calls first_, ends the process or ignores the signal.
  void took_signal(int signal) EXCLUDES(mutex_);

  mutable Mutex mutex_;
  CondVar changed_;
  std::function<void()> first_ GUARDED_BY(mutex_);  // of the newest Listener; empty: none
  bool seen_ GUARDED_BY(mutex_) = false;
  int signals_ = -1;  // signalfd
  int stop_ = -1;     // eventfd: ends the reading thread
  std::thread reader_;
};

}  // namespace bandsaw::coordinator
