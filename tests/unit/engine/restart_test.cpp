// The coordinator is stopped or killed during a job. After its restart, acknowledged bands are not
// rendered again unless they are damaged on disk, and the image is the same. A lease is a band that
// the coordinator gives to a worker to render.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "coordinator/store/band_log.h"
#include "coordinator/store/sqlite_journal.h"
#include "tests/unit/engine/fake_worker.h"
#include "tests/unit/engine/test_farm.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::uint64_t kJobSamples = 512;

bool overlap(const Band& a, const Band& b) {
  return a.samples.first < b.samples.last && b.samples.first < a.samples.last &&
         a.rows.first < b.rows.last && b.rows.first < a.rows.last;
}

/// Returns the number of leases that overlap a band that was acknowledged before.
long rendered_again(const std::vector<Band>& leased, const std::vector<Band>& acknowledged) {
  return std::count_if(leased.begin(), leased.end(), [&](const Band& lease) {
    return std::any_of(acknowledged.begin(), acknowledged.end(),
                       [&](const Band& band) { return overlap(lease, band); });
  });
}

/// The bands that were answered with kStored.
class Acknowledged {
 public:
  /// Returns the callback of a worker that records its acknowledged bands here.
  FakeWorker::Answered hook() {
    return [this](const Band& band, const absl::StatusOr<BandOutcome>& outcome) {
      if (outcome.ok() && *outcome == BandOutcome::kStored) {
        MutexLock lock(mutex_);
        bands_.push_back(band);
      }
    };
  }
  std::vector<Band> bands() {
    MutexLock lock(mutex_);
    return bands_;
  }

 private:
  Mutex mutex_;
  std::vector<Band> bands_ GUARDED_BY(mutex_);
};

/// Waits for the end of the job. Expects that its image has the pixels of a local render.
void expect_local_image(TestFarm& farm, JobId job, std::uint64_t samples) {
  const JobView view = farm.wait_final(job);
  ASSERT_EQ(view.state, JobState::kDone) << view.reason;
  const absl::StatusOr<StoredResult> result = farm.result(job);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->image.pixels, farm.local(samples).pixels);
}

TEST(Restart, NothingAcknowledgedIsLeasedAgainAndTheImageIsTheSame) {
  TestFarm farm;
  ASSERT_TRUE(farm.start().ok());
  const JobId job = farm.begin(StopAtSamples{.samples = kJobSamples});
  Acknowledged acknowledged;
  {
    FakeWorker one(farm.scene(), "one", acknowledged.hook());
    FakeWorker two(farm.scene(), "two", acknowledged.hook());
    one.join(farm.engine());
    two.join(farm.engine());
    farm.wait_until(job, [](const JobView& view) { return view.fraction > 0.1; });
  }
  farm.stop();
  ASSERT_TRUE(farm.start().ok());
  FakeWorker three(farm.scene(), "three");
  three.join(farm.engine());
  expect_local_image(farm, job, kJobSamples);
  EXPECT_FALSE(acknowledged.bands().empty());
  EXPECT_EQ(rendered_again(three.leased(), acknowledged.bands()), 0);
}

TEST(Restart, AFinishedJobKeepsItsResult) {
  TestFarm farm;
  ASSERT_TRUE(farm.start().ok());
  const JobId job = farm.begin(StopAtSamples{.samples = 8});
  {
    FakeWorker one(farm.scene(), "one");
    one.join(farm.engine());
    expect_local_image(farm, job, 8);
  }
  const auto rendered_by = [&] {
    Box<std::vector<RowsBy>> box;
    farm.engine().rendered_by(job, [&](std::vector<RowsBy> rows) { box.put(std::move(rows)); });
    return box.take();
  };
  const std::vector<RowsBy> by_one = {{{0, farm.settings().height}, "one"}};
  EXPECT_EQ(rendered_by(), by_one);
  farm.stop();
  ASSERT_TRUE(farm.start().ok());
  expect_local_image(farm, job, 8);
  EXPECT_EQ(rendered_by(), by_one);
}

/// Starts the farm and a job, and sets `job` to its id. Stops the farm when a worker has rendered a
/// tenth of the job.
void render_a_tenth(TestFarm& farm, JobId& job) {
  ASSERT_TRUE(farm.start().ok());
  job = farm.begin(StopAtSamples{.samples = kJobSamples});
  {
    FakeWorker one(farm.scene(), "one");
    one.join(farm.engine());
    farm.wait_until(job, [](const JobView& view) { return view.fraction > 0.1; });
  }
  farm.stop();
}

TEST(Restart, DamagedBandsAreRenderedAgain) {
  TestFarm farm;
  JobId job = 0;
  ASSERT_NO_FATAL_FAILURE(render_a_tenth(farm, job));
  {
    std::fstream bands(farm.folder() + "/jobs/" + std::to_string(job) + "/bands",
                       std::ios::in | std::ios::out | std::ios::binary);
    bands.seekp(300);  // in the first record
    bands.write("damage", 6);
  }
  ASSERT_TRUE(farm.start().ok());
  FakeWorker two(farm.scene(), "two");
  two.join(farm.engine());
  expect_local_image(farm, job, kJobSamples);
}

/// Appends the last record of a band log again, with other pixels, as a result of the worker
/// process `process`.
void append_contradiction(const std::string& job_folder, std::uint64_t process) {
  std::optional<BandRecord> last;
  BandLogReport report;
  const auto keep = [&](BandRecord record, std::uint64_t) { last = std::move(record); };
  absl::StatusOr<BandLog> log = BandLog::open(job_folder, job_folder + "/bands", keep, report);
  ASSERT_TRUE(log.ok()) << log.status();
  ASSERT_TRUE(last);
  last->process = process;
  last->pixels.sums.front() += 1;
  ASSERT_TRUE(log->append(*last).ok());
  ASSERT_TRUE(log->sync().ok());
}

// The log has two results of one band, which differ. Worker two renders the band again, and its
// result shows which of the two is wrong.
TEST(Restart, ASecondResultOnDiskIsCompared) {
  constexpr std::uint64_t kWrong = 12'345;
  TestFarm farm;
  JobId job = 0;
  ASSERT_NO_FATAL_FAILURE(render_a_tenth(farm, job));
  ASSERT_NO_FATAL_FAILURE(
      append_contradiction(farm.folder() + "/jobs/" + std::to_string(job), kWrong));
  ASSERT_TRUE(farm.start().ok());
  {
    FakeWorker two(farm.scene(), "two");
    two.join(farm.engine());
    expect_local_image(farm, job, kJobSamples);
  }
  farm.stop();
  bool quarantined = false;
  const auto journal = SqliteJournal::open(farm.folder() + "/journal.sqlite");
  ASSERT_TRUE(journal.ok()) << journal.status();
  ASSERT_TRUE((*journal)
                  ->replay([&](const Record& record) {
                    const auto* one = std::get_if<record::WorkerQuarantined>(&record);
                    quarantined = quarantined || (one != nullptr && one->process == kWrong);
                  })
                  .ok());
  EXPECT_TRUE(quarantined)
      << "worker two agrees with worker one, so the other process must be quarantined";
}

/// Runs a coordinator and two workers in this process, a child of the test. Writes each
/// acknowledged band to the pipe `out`, and ends the process when the job is final.
[[noreturn]] void run_farm(TestFarm& farm, int out) {
  const auto tell = [out](const Band& band, const absl::StatusOr<BandOutcome>& outcome) {
    if (outcome.ok() && *outcome == BandOutcome::kStored &&
        ::write(out, &band, sizeof band) != sizeof band) {
      ::_exit(1);
    }
  };
  if (!farm.start().ok()) {
    ::_exit(1);
  }
  FakeWorker one(farm.scene(), "one", tell);
  FakeWorker two(farm.scene(), "two", tell);
  one.join(farm.engine());
  two.join(farm.engine());
  farm.wait_final(farm.begin(StopAtSamples{.samples = kJobSamples}));
  ::_exit(0);
}

TEST(Restart, AfterAKillNothingAcknowledgedIsLostOrLeasedAgain) {
  TestFarm farm;
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    run_farm(farm, ends[1]);
  }
  ::close(ends[1]);
  std::vector<Band> acknowledged;
  Band band;
  while (::read(ends[0], &band, sizeof band) == sizeof band) {
    acknowledged.push_back(band);
    if (acknowledged.size() == 3) {
      ::kill(child, SIGKILL);
    }
  }
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_GE(acknowledged.size(), 3u);
  EXPECT_TRUE(WIFSIGNALED(status));

  ASSERT_TRUE(farm.start().ok());
  FakeWorker three(farm.scene(), "three");
  three.join(farm.engine());
  expect_local_image(farm, /*job=*/1, kJobSamples);
  EXPECT_EQ(rendered_again(three.leased(), acknowledged), 0);
}

}  // namespace
}  // namespace bandsaw::coordinator
