// The executor, which loads scenes and renders a worker's bands.

#include "worker/executor/executor.h"

#include <gtest/gtest.h>

#include <ctime>
#include <map>
#include <new>

#include "renderlib/render/render_band.h"
#include "tests/support/scenes.h"

namespace bandsaw::worker {
namespace {

const RenderSettings kSettings{.width = 24, .height = 24, .max_depth = 3, .seed = 1};

/// Returns the task `id`: 16 samples of `rows` rows from `first_row` on. The manifest of the scene
/// is the one letter `scene`.
Task task(TaskId id, std::uint32_t first_row, std::uint32_t rows, char scene = 'a') {
  return {.id = id,
          .job = 1,
          .manifest = wire::sha256(std::string(1, scene)),
          .settings = kSettings,
          .band = {.samples = {.first = 0, .last = 16},
                   .rows = {.first = first_row, .last = first_row + rows}}};
}

/// Returns the CPU time that this process has used, in seconds.
double cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// An executor that renders the Cornell box for every manifest, and its recorded callbacks.
class ExecutorTest : public ::testing::Test {
 protected:
  ~ExecutorTest() override { executor_.reset(); }

  void start() {
    executor_ = std::make_unique<Executor>(
        pool_,
        [this](const wire::Digest& manifest, const std::atomic<bool>& stop,
               const Prepared& prepared) { return load(manifest, stop, prepared); },
        ExecutorEvents{.preparing = [this](TaskId id, std::uint64_t) { prepared_.push_back(id); },
                       .rendering = [](TaskId, std::uint32_t) {},
                       .finished =
                           [this](FinishedBand band) {
                             MutexLock lock(mutex_);
                             order_.push_back(band.task.id);
                             const TaskId id = band.task.id;
                             finished_.emplace(id, std::move(band));
                             changed_.notify_all();
                           },
                       .failed =
                           [this](const Task& failed, const absl::Status& status) {
                             MutexLock lock(mutex_);
                             failed_.emplace(failed.id, status);
                             changed_.notify_all();
                           }});
  }

  /// Loads the scene of a manifest for the executor. Waits while `gate_closed_` is true.
  absl::StatusOr<std::shared_ptr<const Scene>> load(const wire::Digest& manifest,
                                                    const std::atomic<bool>& stop,
                                                    const Prepared& prepared) {
    MutexLock lock(mutex_);
    loads_.push_back(manifest);
    changed_.notify_all();
    while (gate_closed_ && !stop) {
      changed_.wait_for(mutex_, std::chrono::milliseconds(1));
    }
    if (stop) {
      return absl::CancelledError("stopped");
    }
    prepared(1);  // adds to prepared_; mutex_ is held, so only one thread does this at a time
    if (!load_error_.ok()) {
      return load_error_;
    }
    if (load_needs_too_much_memory_) {
      pool_.parallel_for(1, [](std::int64_t) { throw std::bad_alloc(); });
    }
    std::shared_ptr<const Scene> scene = test::cornell_box().build();
    loaded_cpu_s_ = cpu_s();
    return scene;
  }

  void wait_for_ended(std::size_t count) {
    MutexLock lock(mutex_);
    while (finished_.size() + failed_.size() < count) {
      changed_.wait(mutex_);
    }
  }
  void wait_for_loads(std::size_t count) {
    MutexLock lock(mutex_);
    while (loads_.size() < count) {
      changed_.wait(mutex_);
    }
  }

  Pool pool_{2};
  Mutex mutex_;
  CondVar changed_;
  bool gate_closed_ = false;  ///< while it is true, loading a scene does not end
  absl::Status load_error_;   ///< error that load() returns; OK: none
  bool load_needs_too_much_memory_ = false;
  double loaded_cpu_s_ = 0;          ///< cpu_s() when the last scene was loaded
  std::vector<wire::Digest> loads_;  ///< manifests of the scenes, in the order of their loading
  std::vector<TaskId> prepared_;     ///< tasks for which loading was reported
  std::vector<TaskId> order_;        ///< tasks in the order in which they were finished
  std::map<TaskId, FinishedBand> finished_;
  std::map<TaskId, absl::Status> failed_;
  std::unique_ptr<Executor> executor_;
};

TEST_F(ExecutorTest, RendersTheSamePixelsAsRenderBand) {
  start();
  for (TaskId id = 1; id <= 4; ++id) {
    executor_->add(task(id, static_cast<std::uint32_t>(id - 1) * 6, 6));
  }
  wait_for_ended(4);
  EXPECT_TRUE(failed_.empty());
  EXPECT_EQ(loads_.size(), 1U) << "the scene is loaded once";
  const auto scene = test::cornell_box().build();
  const std::atomic<bool> never{false};
  for (const auto& [id, band] : finished_) {
    const auto expected =
        render_band(*scene, kSettings, band.task.band, pool_, never, [](std::uint32_t) {});
    ASSERT_TRUE(expected.ok()) << expected.status();
    EXPECT_EQ(band.pixels.sums, expected->sums);
    EXPECT_EQ(band.pixels.counters, expected->counters);
    EXPECT_GE(band.cost.render_s, 0);
    EXPECT_GE(band.cost.cpu_s, 0);
  }
}

// The process has used CPU time before it renders the band, at least for the start of the process.
// The cost of the band must not contain this time.
TEST_F(ExecutorTest, CountsTheCpuTimeOfRenderingOnly) {
  start();
  executor_->add(task(1, 0, 1));
  wait_for_ended(1);
  EXPECT_GT(finished_.at(1).cost.cpu_s, 0);
  EXPECT_LE(finished_.at(1).cost.cpu_s, cpu_s() - loaded_cpu_s_);
}

// The third scene, c, replaces b, because a was used later than b. So b is loaded twice.
TEST_F(ExecutorTest, KeepsTheLastTwoScenes) {
  start();
  const char scenes[] = {'a', 'b', 'a', 'c', 'a', 'b'};
  TaskId id = 0;
  for (const char scene : scenes) {
    executor_->add(task(++id, 0, 1, scene));
    wait_for_ended(id);
  }
  std::vector<wire::Digest> expected;
  for (const char scene : {'a', 'b', 'c', 'b'}) {
    expected.push_back(wire::sha256(std::string(1, scene)));
  }
  EXPECT_EQ(loads_, expected);
}

TEST_F(ExecutorTest, ReportsALoadFailureAndTriesAgainForTheNextBand) {
  load_error_ = absl::InvalidArgumentError("mesh[3]: index out of range");
  start();
  executor_->add(task(1, 0, 1));
  wait_for_ended(1);
  ASSERT_TRUE(failed_.contains(1));
  EXPECT_EQ(failed_.at(1), load_error_);
  {
    MutexLock lock(mutex_);
    load_error_ = absl::OkStatus();
  }
  executor_->add(task(2, 0, 1));
  wait_for_ended(2);
  EXPECT_TRUE(finished_.contains(2));
}

// Scenes are built, and bands rendered, by the threads of the pool.
TEST_F(ExecutorTest, ReportsThatAThreadOfThePoolHasTooLittleMemory) {
  load_needs_too_much_memory_ = true;
  start();
  executor_->add(task(1, 0, 1));
  wait_for_ended(1);
  ASSERT_TRUE(failed_.contains(1));
  EXPECT_EQ(failed_.at(1).code(), absl::StatusCode::kResourceExhausted);
  {
    MutexLock lock(mutex_);
    load_needs_too_much_memory_ = false;
  }
  executor_->add(task(2, 0, 1));
  wait_for_ended(2);
  EXPECT_TRUE(finished_.contains(2));
}

TEST_F(ExecutorTest, StopsABandWhoseSceneIsLoading) {
  gate_closed_ = true;
  start();
  executor_->add(task(1, 0, 1));
  executor_->add(task(2, 1, 1));
  executor_->add(task(3, 2, 1));
  wait_for_loads(1);
  executor_->stop(1);
  executor_->stop(3);
  wait_for_loads(2);
  {
    MutexLock lock(mutex_);
    gate_closed_ = false;
  }
  wait_for_ended(1);
  EXPECT_EQ(order_, std::vector<TaskId>{2});
  EXPECT_TRUE(failed_.empty()) << "a band that was stopped is not reported as failed";
}

// Two bands need the same scene. Its loading must be reported for the earlier one, whichever thread
// loads it. Which thread loads it depends on timing, so the test loads 20 scenes.
TEST_F(ExecutorTest, ReportsLoadingUnderTheEarliestTask) {
  start();
  for (TaskId first = 1; first < 40; first += 2) {
    const auto scene = static_cast<char>('a' + first);
    executor_->add(task(first, 0, 1, scene));
    executor_->add(task(first + 1, 1, 1, scene));
    wait_for_ended(first + 1);
    EXPECT_EQ(prepared_, std::vector<TaskId>{first});
    prepared_.clear();
  }
}

TEST_F(ExecutorTest, EndsWithoutFinishingItsBands) {
  gate_closed_ = true;
  start();
  for (TaskId id = 1; id <= 5; ++id) {
    executor_->add(task(id, 0, 1));
  }
  wait_for_loads(1);
  executor_.reset();
  EXPECT_TRUE(finished_.empty());
  EXPECT_TRUE(failed_.empty());
}

}  // namespace
}  // namespace bandsaw::worker
