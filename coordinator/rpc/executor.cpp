// Threads take tasks from one queue in order. The destructor lets them finish the tasks that wait.

#include "coordinator/rpc/executor.h"

namespace bandsaw::coordinator {

FileExecutor::FileExecutor(int threads) {
  for (int i = 0; i < threads; ++i) {
    threads_.emplace_back([this] { run(); });
  }
}

FileExecutor::~FileExecutor() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
  }
  work_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void FileExecutor::post(std::function<void()> task) {
  MutexLock lock(mutex_);
  tasks_.push_back(std::move(task));
  work_.notify_one();
}

void FileExecutor::run() {
  MutexLock lock(mutex_);
  while (true) {
    while (tasks_.empty() && !stopping_) {
      work_.wait(mutex_);
    }
    if (tasks_.empty()) {
      return;
    }
    std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    mutex_.unlock();
    task();
    // The captures of the task are destroyed while the mutex is not locked, because the destructor
    // of a capture may call post(), which locks the mutex.
    task = nullptr;
    mutex_.lock();
  }
}

}  // namespace bandsaw::coordinator
