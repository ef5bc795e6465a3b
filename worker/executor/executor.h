#pragma once

// Renders tasks in the order they came, each on all cores. Two are under way at once, so that the
// first tiles of one fill the cores that the last tiles of the one before leave idle; the later one
// begins only when the earlier one's rows are coming.

#include <atomic>
#include <deque>
#include <functional>
#include <list>
#include <thread>

#include "renderlib/base/mutex.h"
#include "renderlib/base/pool.h"
#include "worker/executor/scene_shelf.h"
#include "worker/executor/task.h"

namespace bandsaw::worker {

/// Told from the executor's and the pool's threads; MUST be quick. For each task: preparing and
/// rendering any number of times, then finished or failed once, unless it was stopped.
struct ExecutorEvents {
  std::function<void(TaskId, std::uint64_t prepared)> preparing;
  std::function<void(TaskId, std::uint32_t rows_done)> rendering;
  std::function<void(FinishedBand)> finished;
  std::function<void(const Task&, const absl::Status&)> failed;
};

class Executor {
 public:
  /// `pool` outlives it.
  Executor(Pool& pool, LoadScene load, ExecutorEvents events);
  /// Stops what is running and waits for it; nothing is told of it any more.
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  void add(const Task& task) EXCLUDES(mutex_);
  /// Waiting: forgotten. Running: ends at the next row of a tile, and nothing more is told of it.
  void stop(TaskId task) EXCLUDES(mutex_);

 private:
  enum class Reached { kTaken, kScene, kRows };
  struct Running {
    explicit Running(const Task& t) : task(t) {}
    const Task task;
    std::atomic<bool> stop{false};
    std::atomic<Reached> reached{Reached::kTaken};
  };
  using RunningList = std::list<Running>;

  void run() EXCLUDES(mutex_);
  void execute(Running& running) EXCLUDES(mutex_);
  absl::StatusOr<FinishedBand> render(Running& running) EXCLUDES(mutex_);
  void reach(Running& running, Reached reached) EXCLUDES(mutex_);
  /// Until every earlier task has come so far. CANCELLED: this one was stopped.
  absl::Status wait_for_earlier(const Running& running, Reached reached) EXCLUDES(mutex_);
  RenderCost cost_since(double began_s) EXCLUDES(mutex_);

  Pool& pool_;
  SceneShelf scenes_;
  const ExecutorEvents events_;
  Mutex mutex_;
  CondVar changed_;
  bool closing_ GUARDED_BY(mutex_) = false;
  std::deque<Task> waiting_ GUARDED_BY(mutex_);
  RunningList running_ GUARDED_BY(mutex_);  ///< in the order they were taken
  double last_end_s_ GUARDED_BY(mutex_) = 0;
  double last_cpu_s_ GUARDED_BY(mutex_) = 0;
  std::vector<std::thread> threads_;
};

}  // namespace bandsaw::worker
