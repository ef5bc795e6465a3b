#pragma once

// Renders tasks (leased bands) in their order of arrival, each on all cores. Two tasks run at the
// same time. When the last tiles of the earlier task leave cores idle, the first tiles of the later
// task use these cores. The rendering of the later task begins when the first row of the earlier
// task is finished.

#include <atomic>
#include <deque>
#include <functional>
#include <list>
#include <thread>

#include "renderlib/base/mutex.h"
#include "renderlib/base/pool.h"
#include "worker/executor/scene_cache.h"
#include "worker/executor/task.h"

namespace bandsaw::worker {

/// Callbacks, called from the executor's and the pool's threads; MUST be quick. For each task,
/// `preparing` and `rendering` are called any number of times, then `finished` or `failed` once.
/// `preparing` reports that the scene is being loaded; `prepared` is a measure of the progress,
/// which grows from call to call. `rendering` reports the number of finished rows. It reports 0
/// when rendering begins. Before the first row there may be preparations, such as the training of
/// path guiding, and `rendering` reports 0 after each of their steps. A task that is stopped gets
/// no further callbacks.
struct ExecutorEvents {
  std::function<void(TaskId, std::uint64_t prepared)> preparing;
  std::function<void(TaskId, std::uint32_t rows_done)> rendering;
  std::function<void(FinishedBand)> finished;
  std::function<void(const Task&, const absl::Status&)> failed;
};

class Executor {
 public:
  /// `load`: loads a scene that is not among the last two. `pool` MUST outlive the executor.
  Executor(Pool& pool, LoadScene load, ExecutorEvents events);
  /// Stops the running tasks and waits for them, without further callbacks.
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  void add(const Task& task) EXCLUDES(mutex_);
  /// Cancels a task. A waiting task is removed; a running one ends at the next row of a tile. The
  /// task gets no further callbacks.
  void stop(TaskId task) EXCLUDES(mutex_);

 private:
  /// How far a task has got: a thread took it, its scene is loaded, its first row is finished.
  enum class Reached { kTaken, kScene, kRows };
  struct Running {
    explicit Running(const Task& t) : task(t) {}
    const Task task;
    std::atomic<bool> stop{false};
    std::atomic<Reached> reached{Reached::kTaken};
  };
  using RunningList = std::list<Running>;

  void run() EXCLUDES(mutex_);
  /// Renders a task and calls `finished` or `failed`, unless the task was stopped.
  void execute(Running& running) EXCLUDES(mutex_);
  absl::StatusOr<FinishedBand> render(Running& running) EXCLUDES(mutex_);
  /// Notes that the task has got to `reached`, and wakes the tasks that wait for it.
  void reach(Running& running, Reached reached) EXCLUDES(mutex_);
  /// Waits until every earlier task has reached `reached`. CANCELLED: this task was stopped.
  absl::Status wait_for_earlier(const Running& running, Reached reached) EXCLUDES(mutex_);
  /// To be called when a band is rendered. Returns the time, and the CPU time of the process, since
  /// the later of two moments: `began`, when the rendering of this band began, and the previous
  /// call. The CPU time may include the loading of the next band's scene.
  RenderCost cost_since(const RenderCost& began) EXCLUDES(mutex_);

  Pool& pool_;
  SceneCache scenes_;
  const ExecutorEvents events_;
  Mutex mutex_;
  CondVar changed_;
  bool closing_ GUARDED_BY(mutex_) = false;
  std::deque<Task> waiting_ GUARDED_BY(mutex_);
  RunningList running_ GUARDED_BY(mutex_);  ///< in the order in which they were started
  RenderCost last_end_ GUARDED_BY(mutex_);  ///< the clocks when the last band ended
  std::vector<std::thread> threads_;
};

}  // namespace bandsaw::worker
