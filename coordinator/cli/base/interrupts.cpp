// SIGINT, SIGTERM and SIGHUP are blocked in all threads, and one thread reads them from a signalfd.
// The first signal calls the function of the newest Listener. Without a Listener, the first signal
// ends the program at once. After the first signal, SIGINT or SIGTERM ends the program at once, and
// SIGHUP is ignored.

#include "coordinator/cli/base/interrupts.h"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>
#include <utility>

#include "coordinator/cli/base/exit_code.h"
#include "renderlib/base/check.h"

namespace bandsaw::coordinator {

Interrupts::Interrupts() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  // SIGHUP is sent when a terminal is closed. It is blocked and read like the other signals. A
  // program that was started with nohup ignores SIGHUP from its start, and continues to do so.
  struct sigaction hang_up {};
  if (sigaction(SIGHUP, nullptr, &hang_up) == 0 && hang_up.sa_handler != SIG_IGN) {
    sigaddset(&set, SIGHUP);
  }
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signals_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  stop_ = eventfd(0, EFD_CLOEXEC);
  BANDSAW_CHECK(signals_ >= 0 && stop_ >= 0, "a process that just began can open two files");
  reader_ = std::thread([this] { read(); });
}

Interrupts::~Interrupts() {
  eventfd_write(stop_, 1);
  reader_.join();
  close(signals_);
  close(stop_);
}

void Interrupts::read() {
  pollfd files[] = {{signals_, POLLIN, 0}, {stop_, POLLIN, 0}};
  for (;;) {
    poll(files, 2, -1);
    signalfd_siginfo info{};
    while (::read(signals_, &info, sizeof info) == sizeof info) {
      took_signal(static_cast<int>(info.ssi_signo));
    }
    if ((files[1].revents & POLLIN) != 0) {
      return;
    }
  }
}

void Interrupts::took_signal(int signal) {
  MutexLock lock(mutex_);
  if (seen_ && signal == SIGHUP) {
    // When a terminal is closed, the shell and the kernel may both send SIGHUP. So a second one
    // does not mean that the user wants to force the end.
    return;
  }
  if (seen_ || !first_) {
    _exit(static_cast<int>(ExitCode::kInterrupted));
  }
  seen_ = true;
  first_();
  changed_.notify_all();
}

void Interrupts::wait() {
  MutexLock lock(mutex_);
  while (!seen_) {
    changed_.wait(mutex_);
  }
}

bool Interrupts::seen() const {
  MutexLock lock(mutex_);
  return seen_;
}

Interrupts::Listener::Listener(Interrupts& interrupts, std::function<void()> first)
    : interrupts_(interrupts) {
  MutexLock lock(interrupts_.mutex_);
  before_ = std::exchange(interrupts_.first_, std::move(first));
}

Interrupts::Listener::~Listener() {
  MutexLock lock(interrupts_.mutex_);
  interrupts_.first_ = std::move(before_);
}

}  // namespace bandsaw::coordinator
