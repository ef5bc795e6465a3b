// Two threads take tasks in order. Each loads the scene of its task and renders the band of its
// task. The later task waits for the earlier task twice (wait_for_earlier): until the scene of the
// earlier task is loaded, and until the first row of the earlier task is finished.

#include "worker/executor/executor.h"

#include <algorithm>
#include <ctime>
#include <new>

#include "renderlib/base/status_macros.h"
#include "renderlib/render/render_band.h"

namespace bandsaw::worker {
namespace {

constexpr int kBandsAtOnce = 2;

double seconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Returns the time since a fixed moment, and the CPU time that this process has used.
RenderCost time_now() {
  return {.render_s = seconds(CLOCK_MONOTONIC), .cpu_s = seconds(CLOCK_PROCESS_CPUTIME_ID)};
}

}  // namespace

Executor::Executor(Pool& pool, LoadScene load, ExecutorEvents events)
    : pool_(pool), scenes_(std::move(load)), events_(std::move(events)) {
  for (int i = 0; i < kBandsAtOnce; ++i) {
    threads_.emplace_back([this] { run(); });
  }
}

Executor::~Executor() {
  {
    MutexLock lock(mutex_);
    closing_ = true;
    waiting_.clear();
    for (Running& running : running_) {
      running.stop = true;
    }
    changed_.notify_all();
  }
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void Executor::add(const Task& task) {
  MutexLock lock(mutex_);
  waiting_.push_back(task);
  changed_.notify_all();
}

void Executor::stop(TaskId task) {
  MutexLock lock(mutex_);
  std::erase_if(waiting_, [task](const Task& waiting) { return waiting.id == task; });
  for (Running& running : running_) {
    if (running.task.id == task) {
      running.stop = true;
    }
  }
  changed_.notify_all();
}

void Executor::run() {
  while (true) {
    RunningList::iterator mine;
    {
      MutexLock lock(mutex_);
      while (waiting_.empty() && !closing_) {
        changed_.wait(mutex_);
      }
      if (closing_) {
        return;
      }
      mine = running_.emplace(running_.end(), waiting_.front());
      waiting_.pop_front();
    }
    execute(*mine);
    MutexLock lock(mutex_);
    running_.erase(mine);
    changed_.notify_all();
  }
}

void Executor::execute(Running& running) {
  absl::StatusOr<FinishedBand> band = absl::InternalError("not rendered");
  try {
    band = render(running);
  } catch (const std::bad_alloc&) {
    // Thrown by the standard library: the scene or the band needs too much memory.
    band = absl::ResourceExhaustedError("not enough memory for the scene or the band");
  }
  if (running.stop) {
    return;
  }
  if (band.ok()) {
    events_.finished(*std::move(band));
  } else {
    events_.failed(running.task, band.status());
  }
}

absl::StatusOr<FinishedBand> Executor::render(Running& running) {
  const Task& task = running.task;
  // The earliest task loads the scene, so that the progress of loading counts for the lease that
  // must advance first.
  RETURN_IF_ERROR(wait_for_earlier(running, Reached::kScene));
  ASSIGN_OR_RETURN(const std::shared_ptr<const Scene> scene,
                   scenes_.get(task.manifest, running.stop, [&](std::uint64_t prepared) {
                     events_.preparing(task.id, prepared);
                   }));
  reach(running, Reached::kScene);
  RETURN_IF_ERROR(wait_for_earlier(running, Reached::kRows));
  events_.rendering(task.id, 0);
  const RenderCost began = time_now();
  ASSIGN_OR_RETURN(BandPixels pixels, render_band(
                                          *scene, task.settings, task.band, pool_, running.stop,
                                          [&](std::uint32_t rows_done) {
                                            events_.rendering(task.id, rows_done);
                                            if (rows_done > 0) {
                                              reach(running, Reached::kRows);
                                            }
                                          },
                                          task.tiles));
  return FinishedBand{.task = task, .pixels = std::move(pixels), .cost = cost_since(began)};
}

void Executor::reach(Running& running, Reached reached) {
  if (running.reached.exchange(reached) != reached) {
    MutexLock lock(mutex_);
    changed_.notify_all();
  }
}

absl::Status Executor::wait_for_earlier(const Running& running, Reached reached) {
  MutexLock lock(mutex_);
  const auto earlier_are_there = [&]() REQUIRES(mutex_) {
    for (const Running& other : running_) {
      if (&other == &running) {
        break;
      }
      if (other.reached.load() < reached) {
        return false;
      }
    }
    return true;
  };
  while (!running.stop && !earlier_are_there()) {
    changed_.wait(mutex_);
  }
  return running.stop ? absl::CancelledError("stopped") : absl::OkStatus();
}

RenderCost Executor::cost_since(const RenderCost& began) {
  MutexLock lock(mutex_);
  const RenderCost now = time_now();  // under the lock, so that it is not earlier than last_end_
  const RenderCost cost{.render_s = now.render_s - std::max(began.render_s, last_end_.render_s),
                        .cpu_s = now.cpu_s - std::max(began.cpu_s, last_end_.cpu_s)};
  last_end_ = now;
  return cost;
}

}  // namespace bandsaw::worker
