#pragma once

// A few threads for work that waits for the disk or for the film (the sums of all pixels of a job),
// because gRPC's callbacks must not block.

#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class FileExecutor {
 public:
  /// Starts this number of threads.
  explicit FileExecutor(int threads);
  /// Runs the tasks that are still queued, then ends the threads. MUST NOT be called while other
  /// threads may still call post().
  ~FileExecutor();
  FileExecutor(const FileExecutor&) = delete;
  FileExecutor& operator=(const FileExecutor&) = delete;

  /// Adds a task. Tasks start in the order in which they were posted, and several tasks run at the
  /// same time. A stream posts its next task only after the read or write that its last task
  /// started has ended. So the tasks of one stream never overlap.
  void post(std::function<void()> task) EXCLUDES(mutex_);

 private:
  void run() EXCLUDES(mutex_);

  Mutex mutex_;
  CondVar work_;
  std::deque<std::function<void()>> tasks_ GUARDED_BY(mutex_);
  bool stopping_ GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace bandsaw::coordinator
