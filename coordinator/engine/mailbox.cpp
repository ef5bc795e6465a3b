// A thread takes all waiting tasks as one batch, runs them in order, and then calls after_batch().
// It also calls after_batch() after each period in which no task was posted.

#include "coordinator/engine/mailbox.h"

#include <utility>

namespace bandsaw::coordinator {

void Mailbox::start() {
  thread_ = std::thread([this] { run(); });
}

void Mailbox::post(Task task) {
  {
    MutexLock lock(mutex_);
    if (!stopped_) {
      tasks_.push_back(std::move(task));
    }
  }
  // A task that was posted after stop() is destroyed at the end of this function, when the mutex is
  // not locked. The destructor of the task may call an Answer, and the callback of the Answer may
  // call post(). If the mutex were locked, this would be a deadlock.
  wake_.notify_one();
}

void Mailbox::stop() {
  std::vector<Task> dropped;
  {
    MutexLock lock(mutex_);
    stopped_ = true;
    dropped.swap(tasks_);
  }
  wake_.notify_one();
  if (thread_.joinable()) {
    thread_.join();
  }
}

bool Mailbox::take(std::vector<Task>& batch) {
  const auto until = std::chrono::steady_clock::now() + period_;
  MutexLock lock(mutex_);
  while (tasks_.empty() && !stopped_) {
    const auto left = until - std::chrono::steady_clock::now();
    if (left.count() <= 0 || !wake_.wait_for(mutex_, left)) {
      break;
    }
  }
  batch.swap(tasks_);
  return !stopped_;
}

void Mailbox::run() {
  std::vector<Task> batch;
  while (take(batch)) {
    for (Task& task : batch) {
      task();
      task = nullptr;
    }
    batch.clear();
    after_batch_();
  }
}

}  // namespace bandsaw::coordinator
