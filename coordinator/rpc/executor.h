#pragma once

// A few threads for work that waits, for the disk or for the film: gRPC's reactions must not.

#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class FileExecutor {
 public:
  explicit FileExecutor(int threads);
  /// Does what is still queued, then ends. Nothing may be posted any more.
  ~FileExecutor();
  FileExecutor(const FileExecutor&) = delete;
  FileExecutor& operator=(const FileExecutor&) = delete;

  /// Tasks begin in the order they were posted; those of one stream never overlap, because each
  /// posts its next one itself.
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
