// A disk that becomes full during a job, and a journal that cannot be written. The journal holds
// the records from which a restarted coordinator restores its jobs. The full disk is simulated by a
// limit on the size of files, so its error is "File too large".

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>

#include "renderlib/render/render_band.h"
#include "tests/support/full_disk.h"
#include "tests/unit/engine/fake_worker.h"
#include "tests/unit/engine/fakes.h"
#include "tests/unit/engine/test_farm.h"

namespace bandsaw::coordinator {
namespace {

using testing::HasSubstr;

class FullDiskTest : public testing::Test {
 protected:
  /// The engine's time stands still unless a test advances it. The journal is in memory.
  FullDiskTest() {
    EngineDependencies dependencies;
    dependencies.clock = std::make_unique<FakeClock>(time_);
    dependencies.journal = std::make_unique<MemoryJournal>(disk_);
    EXPECT_TRUE(farm_.start(std::move(dependencies)).ok());
  }
  /// Renders rows [first, last) of the 14 rows of the image.
  BandPixels rendered(std::uint32_t first, std::uint32_t last) {
    Pool pool(1);
    const std::atomic<bool> stop{false};
    const Band band{.samples = {0, 8}, .rows = {first, last}};
    return *render_band(*farm_.scene(), farm_.settings(), band, pool, stop, [](std::uint32_t) {});
  }
  /// Advances the time until the job is in the state.
  JobView wait_for(JobId job, JobState state) {
    while (true) {
      time_->advance(0.5);
      if (const JobView view = farm_.view(job); view.state == state) {
        return view;
      }
    }
  }
  void expect_local_image(JobId job) {
    EXPECT_EQ(wait_for(job, JobState::kDone).samples_per_pixel, 8u);
    EXPECT_EQ(farm_.result(job)->image.pixels, farm_.local(8).pixels);
  }

  std::shared_ptr<FakeTime> time_ = std::make_shared<FakeTime>();
  std::shared_ptr<JournalDisk> disk_ = std::make_shared<JournalDisk>();
  TestFarm farm_;
};

TEST_F(FullDiskTest, ABandThatDoesNotFitIsKeptByItsWorkerAndTheJobWaits) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  ASSERT_TRUE(farm_.put(job, rendered(0, 7)).ok());
  {
    const test::FullDisk full(/*bytes=*/0);
    const absl::Status refused = farm_.put(job, rendered(7, 14)).status();
    EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
    EXPECT_THAT(wait_for(job, JobState::kPaused).reason, HasSubstr("File too large"));
  }
  wait_for(job, JobState::kRunning);
  EXPECT_EQ(*farm_.put(job, rendered(7, 14)), BandOutcome::kStored);
  expect_local_image(job);
}

TEST_F(FullDiskTest, AWaitingJobIsFinishedOnceTheDiskHasSpace) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  auto full = std::make_unique<test::FullDisk>(/*bytes=*/0);
  FakeWorker worker(farm_.scene(), "one");
  worker.join(farm_.engine());
  wait_for(job, JobState::kPaused);
  full.reset();
  expect_local_image(job);
}

TEST_F(FullDiskTest, AResultThatCannotBeWrittenIsWrittenLater) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  // The result is first written to a file of this name. A folder of the same name prevents this.
  const std::string in_the_way =
      farm_.folder() + "/jobs/" + std::to_string(job) + "/result.incoming";
  ASSERT_TRUE(farm_.put(job, rendered(0, 7)).ok());
  ASSERT_TRUE(std::filesystem::create_directory(in_the_way));
  ASSERT_TRUE(farm_.put(job, rendered(7, 14)).ok());
  EXPECT_THAT(wait_for(job, JobState::kPaused).reason, HasSubstr("result"));
  ASSERT_TRUE(std::filesystem::remove(in_the_way));
  expect_local_image(job);
}

TEST_F(FullDiskTest, ASubmitThatCannotBeJournalledFailsAndDoesNotBeginLater) {
  const JobSpec spec = farm_.spec(StopAtSamples{.samples = 8});
  disk_->break_it();
  const absl::Status refused = farm_.submit(spec).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("journal"));
  disk_->mend();
  absl::StatusOr<JobId> job = farm_.submit(spec);
  while (!job.ok()) {
    time_->advance(1);
    job = farm_.submit(spec);
  }
  ASSERT_TRUE(farm_.put(*job, rendered(0, 14)).ok());
  expect_local_image(*job);
}

TEST_F(FullDiskTest, ASecondSubmitThatCannotBeJournalledLeavesTheJobUnchanged) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  ASSERT_TRUE(farm_.put(job, rendered(0, 14)).ok());
  wait_for(job, JobState::kDone);
  JobSpec same = farm_.spec(StopAtSamples{.samples = 8});
  disk_->break_it();
  // The second submit of a job makes no record. So another job is submitted just before it. The
  // record of this other job cannot be written, and records are written together.
  JobSpec other = same;
  other.request_id = "another request id";
  Box<absl::Status> said;
  farm_.engine().submit(other, [](const absl::StatusOr<JobId>&) {});
  farm_.engine().submit(same, [&](const absl::StatusOr<JobId>& id) { said.put(id.status()); });
  said.take().IgnoreError();  // the answer may be an error, but must come
  disk_->mend();
  expect_local_image(job);
}

TEST_F(FullDiskTest, ResumingIsRefusedWhileTheJournalCannotBeWritten) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  ASSERT_TRUE(farm_.put(job, rendered(0, 7)).ok());
  disk_->break_it();
  EXPECT_FALSE(farm_.put(job, rendered(7, 14)).ok());
  wait_for(job, JobState::kPaused);
  Box<absl::Status> said;
  farm_.engine().resume(job, [&](const absl::StatusOr<JobView>& view) { said.put(view.status()); });
  EXPECT_EQ(said.take().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(wait_for(job, JobState::kPaused).state, JobState::kPaused);
  disk_->mend();
  expect_local_image(job);
}

TEST_F(FullDiskTest, NothingIsAcknowledgedBeforeTheJournalHoldsIt) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  disk_->break_it();
  // The band completes the job. So the job's new state, kFinishing, must be in the journal before
  // the band is acknowledged.
  EXPECT_EQ(farm_.put(job, rendered(0, 14)).status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(farm_.result(job).status().code(), absl::StatusCode::kFailedPrecondition);
  disk_->mend();
  expect_local_image(job);
}

TEST(StartOnAFullDisk, ServesOldResultsRefusesNewDataAndContinues) {
  TestFarm farm;
  ASSERT_TRUE(farm.start().ok());
  JobSpec spec = farm.spec(StopAtSamples{.samples = 8});
  const JobId done = *farm.submit(spec);
  {
    FakeWorker worker(farm.scene(), "one");
    worker.join(farm.engine());
    farm.wait_final(done);
  }
  spec.request_id = "a job that is at work";
  spec.stop = StopAtSamples{.samples = 512};
  const JobId job = *farm.submit(spec);
  {
    FakeWorker worker(farm.scene(), "one");
    worker.join(farm.engine());
    farm.wait_until(job, [](const JobView& view) { return view.fraction > 0.1; });
  }
  farm.stop();
  auto full = std::make_unique<test::FullDisk>(/*bytes=*/0);
  const absl::Status started = farm.start();
  ASSERT_TRUE(started.ok()) << started;
  EXPECT_EQ(farm.result(done)->image.pixels, farm.local(8).pixels);
  EXPECT_THAT(
      farm.wait_until(job, [](const JobView& v) { return v.state == JobState::kPaused; }).reason,
      HasSubstr("disk is full"));
  EXPECT_GT(farm.view(job).fraction, 0.1) << "the bands in the log must be known";
  JobSpec another = spec;
  another.request_id = "a job that is new";
  const absl::Status refused = farm.submit(another).status();
  EXPECT_EQ(refused.code(), absl::StatusCode::kResourceExhausted) << refused;
  EXPECT_EQ(farm.engine().write_blob(wire::sha256("new"), 3).status().code(),
            absl::StatusCode::kResourceExhausted);
  full.reset();
  FakeWorker worker(farm.scene(), "two");
  worker.join(farm.engine());
  ASSERT_EQ(farm.wait_final(job).state, JobState::kDone);
  EXPECT_EQ(farm.result(job)->image.pixels, farm.local(512).pixels);
}

// The reserve is a file that occupies disk space. When the journal cannot be written, the file is
// deleted, so that the journal has space. New jobs are still refused.
TEST_F(FullDiskTest, TheReserveIsFreedForTheJournal) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  JobSpec another = farm_.spec(StopAtSamples{.samples = 8});
  another.request_id = "another request id";
  ASSERT_TRUE(file_exists(farm_.folder() + "/reserve"));
  // The journal behaves as on a disk that has no space until the reserve is deleted.
  disk_->refuse_while([file = farm_.folder() + "/reserve"] { return file_exists(file); });
  Box<absl::Status> said;
  farm_.engine().cancel(job, [&](const absl::StatusOr<JobView>& view) { said.put(view.status()); });
  EXPECT_TRUE(said.take().ok());
  EXPECT_EQ(farm_.view(job).state, JobState::kCancelled);
  EXPECT_EQ(farm_.submit(another).status().code(), absl::StatusCode::kResourceExhausted);
  disk_->refuse_while(nullptr);
}

TEST(BrokenJournal, ARestartContinuesAfterAFailureOfAnyAppend) {
  for (int appends = 0; appends < 6; ++appends) {
    TestFarm farm;
    const auto disk = std::make_shared<JournalDisk>();
    const auto start = [&] {
      EngineDependencies dependencies;
      dependencies.journal = std::make_unique<MemoryJournal>(disk);
      ASSERT_TRUE(farm.start(std::move(dependencies)).ok());
    };
    start();
    disk->break_after(appends);
    const JobSpec spec = farm.spec(StopAtSamples{.samples = 64});
    const absl::StatusOr<JobId> first = farm.submit(spec);
    {
      FakeWorker worker(farm.scene(), "one");
      worker.join(farm.engine());
      if (first.ok()) {
        while (farm.view(*first).state == JobState::kRunning) {
        }
      }
    }
    farm.stop();
    disk->mend();
    start();
    EXPECT_EQ(first.ok(), appends > 0);  // the submit needs the first append
    const absl::StatusOr<JobId> job = farm.submit(spec);
    ASSERT_TRUE(job.ok()) << job.status();
    if (first.ok()) {
      EXPECT_EQ(*job, *first) << "an acknowledged job must be known after the restart";
    }
    FakeWorker worker(farm.scene(), "two");
    worker.join(farm.engine());
    ASSERT_EQ(farm.wait_final(*job).state, JobState::kDone);
    EXPECT_EQ(farm.result(*job)->image.pixels, farm.local(64).pixels);
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
