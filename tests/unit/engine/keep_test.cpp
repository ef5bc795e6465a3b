// A coordinator that receives thousands of jobs forgets its oldest final jobs. A collection, which
// removes these jobs, takes place every ten minutes, and also after a thousand new jobs. Here the
// coordinator keeps five final jobs.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/unit/engine/fakes.h"
#include "tests/unit/engine/test_farm.h"

namespace bandsaw::coordinator {
namespace {

class KeepTest : public ::testing::Test {
 protected:
  void SetUp() override {
    EngineDependencies dependencies;
    dependencies.journal = std::make_unique<MemoryJournal>(std::make_shared<JournalDisk>());
    ASSERT_TRUE(farm_.start(std::move(dependencies), {.jobs = 5}).ok());
    spec_ = farm_.spec(StopAtSamples{.samples = 64});
  }

  /// Submits `jobs` jobs and returns their ids. Waits only for the last answer, because a wait for
  /// each answer would include a disk access.
  std::vector<JobId> submit(std::size_t jobs) {
    Box<std::vector<JobId>> box;
    std::vector<JobId> submitted;  // written by the engine's thread, which answers in order
    for (std::size_t i = 0; i < jobs; ++i) {
      spec_.request_id = absl::StrCat("one-of-many-requests-", ++requests_);
      farm_.engine().submit(spec_, [&, jobs](const absl::StatusOr<JobId>& job) {
        submitted.push_back(job.value_or(0));
        if (submitted.size() == jobs) {
          box.put(submitted);
        }
      });
    }
    return box.take();
  }
  void cancel(const std::vector<JobId>& jobs) {
    Box<bool> done;
    for (const JobId job : jobs) {
      farm_.engine().cancel(job, [&, job](const absl::StatusOr<JobView>& view) {
        EXPECT_TRUE(view.ok()) << view.status();
        if (job == jobs.back()) {
          done.put(true);
        }
      });
    }
    done.take();
  }
  std::vector<JobView> jobs() {
    Box<std::vector<JobView>> box;
    farm_.engine().jobs([&](std::vector<JobView> views) { box.put(std::move(views)); });
    return box.take();
  }

  bool is_known(JobId job) {
    Box<bool> box;
    farm_.engine().watch(job, [&](const absl::StatusOr<JobView>& view) {
      box.put(view.ok());
      return false;
    });
    return box.take();
  }

  TestFarm farm_;
  JobSpec spec_;
  int requests_ = 0;
};

TEST_F(KeepTest, TheThousandthJobRemovesTheOldestFinalJobs) {
  // After this call the first collection is done. The next collection is due ten minutes or a
  // thousand jobs later.
  EXPECT_TRUE(jobs().empty());
  const std::vector<JobId> cancelled = submit(990);
  cancel(cancelled);
  EXPECT_EQ(jobs().size(), 990u);
  submit(20);
  // Waits until the collection at the thousandth job has removed the oldest job.
  for (int asked = 0; asked < 1'000'000 && is_known(cancelled.front()); ++asked) {
  }
  const std::vector<JobView> left = jobs();
  ASSERT_EQ(left.size(), 25u) << "five final jobs and twenty running ones must be left";
  EXPECT_EQ(std::count_if(left.begin(), left.end(),
                          [](const JobView& job) { return is_final(job.state); }),
            5);
  // The five final jobs that are left are the latest five of the 990.
  EXPECT_TRUE(std::all_of(left.begin(), left.end(),
                          [&](const JobView& job) { return job.id >= cancelled[985]; }));
}

}  // namespace
}  // namespace bandsaw::coordinator
