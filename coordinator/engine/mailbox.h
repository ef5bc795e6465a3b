#pragma once

// A thread and its queue of tasks. The thread runs the tasks one after the other, in the order in
// which they were posted.

#include <chrono>
#include <functional>
#include <thread>
#include <tuple>
#include <utility>
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

  /// Starts the thread, which also does the tasks that were posted before. Call once.
  void start();
  /// Adds a task. May be called on any thread. After stop, the task is dropped. The queue has no
  /// bound of its own, because the senders are bounded: bands by their bytes, workers and jobs by
  /// their number.
  void post(Task task) EXCLUDES(mutex_);
  /// Ends the thread after its current batch and drops the waiting tasks. MUST NOT be called on the
  /// thread of the mailbox.
  void stop() EXCLUDES(mutex_);

 private:
  void run() EXCLUDES(mutex_);
  /// Waits until there is a task, `period_` has passed, or the mailbox is stopped. Then moves all
  /// waiting tasks to `batch`, which MUST be empty. Returns false if the mailbox was stopped.
  bool take(std::vector<Task>& batch) EXCLUDES(mutex_);

  std::function<void()> after_batch_;
  std::chrono::milliseconds period_;
  Mutex mutex_;
  CondVar wake_;
  std::vector<Task> tasks_ GUARDED_BY(mutex_);
  bool stopped_ GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

/// Calls methods of an object on the thread of a mailbox. Only this thread uses the object.
template <class T>
class Posting {
 public:
  /// `object` and `mailbox` MUST outlive the Posting.
  Posting(T& object, Mailbox& mailbox) : object_(object), mailbox_(mailbox) {}

  /// Posts `task`, which is called with the object.
  template <class Task>
  void post(Task task) {
    mailbox_.post([&object = object_, task = std::move(task)]() mutable { task(object); });
  }
  /// Posts a call of `method`. The arguments are kept in the task and moved into the call; a result
  /// is dropped.
  template <class Result, class... Parameters, class... Arguments>
  void call(Result (T::*method)(Parameters...), Arguments&&... arguments) {
    post([method,
          kept = std::make_tuple(std::forward<Arguments>(arguments)...)](T& object) mutable {
      std::apply([&](auto&... each) { static_cast<void>((object.*method)(std::move(each)...)); },
                 kept);
    });
  }

 private:
  T& object_;
  Mailbox& mailbox_;
};

}  // namespace bandsaw::coordinator
