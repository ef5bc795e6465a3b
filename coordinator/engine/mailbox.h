#pragma once

// A thread and what it has to do: tasks, done one after the other in the order they were posted.

#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include "absl/functional/any_invocable.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class Mailbox {
 public:
  using Task = absl::AnyInvocable<void()>;

  /// `after_batch` runs on the thread after each batch of tasks (all that were waiting), and at
  /// least every `period`.
  Mailbox(std::function<void()> after_batch, std::chrono::milliseconds period)
      : after_batch_(std::move(after_batch)), period_(period) {}
  ~Mailbox() { stop(); }
  Mailbox(const Mailbox&) = delete;
  Mailbox& operator=(const Mailbox&) = delete;

  /// Tasks posted before wait for it. Call once.
  void start();
  /// Any thread. After stop: the task is dropped. The queue has no bound of its own: what may pile
  /// up is bounded by those who post (bands by their bytes, workers and jobs by their number).
  void post(Task task) EXCLUDES(mutex_);
  /// Ends after the batch it is at; what waits is dropped. Not from its own thread.
  void stop() EXCLUDES(mutex_);

 private:
  void run() EXCLUDES(mutex_);
  /// The next batch, empty after `period_`. False: stopped.
  bool take(std::vector<Task>& batch) EXCLUDES(mutex_);

  std::function<void()> after_batch_;
  std::chrono::milliseconds period_;
  Mutex mutex_;
  CondVar wake_;
  std::vector<Task> tasks_ GUARDED_BY(mutex_);
  bool stopped_ GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace bandsaw::coordinator
