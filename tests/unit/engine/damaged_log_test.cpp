// The band log of an unfinished job is damaged on disk. The band log is the file with the bands
// that workers have rendered. The damage is detected while the coordinator runs, or when the
// coordinator is restarted. Then the lost bands are rendered again.

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>

#include "absl/strings/str_join.h"
#include "tests/unit/engine/fake_worker.h"
#include "tests/unit/engine/test_farm.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::uint64_t kSamples = 1024;

enum class Damage { kFlippedByte, kCutTail, kNoFile };

/// Damages a band log. Its records are larger than 500 bytes, so at least the first one is lost.
void do_damage(const std::string& file, Damage damage) {
  const std::uintmax_t size = std::filesystem::file_size(file);
  ASSERT_GT(size, 1000u);
  switch (damage) {
    case Damage::kFlippedByte: {
      std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
      bytes.seekg(500);
      const int old_byte = bytes.get();
      bytes.seekp(500);
      bytes.put(static_cast<char>(old_byte ^ 4));
      break;
    }
    case Damage::kCutTail:
      std::filesystem::resize_file(file, 400);  // in the first record
      break;
    case Damage::kNoFile:
      std::filesystem::remove(file);
  }
}

class DamagedLog : public testing::TestWithParam<Damage> {
 protected:
  DamagedLog() { EXPECT_TRUE(farm_.start().ok()); }

  /// Puts a worker into quarantine, as if it had returned wrong pixels.
  absl::Status quarantine(const std::string& worker) {
    Box<absl::Status> said;
    farm_.engine().quarantine(worker, /*lift=*/false,
                              [&](absl::Status status) { said.put(status); });
    return said.take();
  }
  /// Calls `what`, such as Engine::pause, for the job, and returns the status of the answer.
  absl::Status tell(void (Engine::*what)(JobId, std::function<void(absl::StatusOr<JobView>)>),
                    JobId job) {
    Box<absl::Status> said;
    (farm_.engine().*what)(job, [&](const absl::StatusOr<JobView>& v) { said.put(v.status()); });
    return said.take();
  }
  /// Resumes a paused job, lets a worker render at least one band, and pauses it again.
  void render_some(JobId job, const std::string& worker) {
    std::atomic<int> stored{0};
    FakeWorker one(farm_.scene(), worker,
                   [&](const Band&, const absl::StatusOr<BandOutcome>& outcome) {
                     // This runs on the worker's thread. After the pause, the worker may still
                     // render one band, but not two.
                     if (outcome.ok() && ++stored == 1) {
                       EXPECT_TRUE(tell(&Engine::pause, job).ok());
                     }
                   });
    one.join(farm_.engine());
    EXPECT_TRUE(tell(&Engine::resume, job).ok());
    farm_.wait_until(job,
                     [&](const JobView& v) { return stored >= 1 && v.state == JobState::kPaused; });
  }
  /// Submits a job of which two workers render a part, and pauses it.
  JobId begin_and_render_a_part() {
    const JobId job = farm_.begin(StopAtSamples{.samples = kSamples});
    EXPECT_TRUE(tell(&Engine::pause, job).ok());
    render_some(job, "keeps");
    render_some(job, "wrong");
    return job;
  }
  /// Lets the running coordinator read the damaged log, and waits until it reports the damage.
  void find_damage(JobId job) {
    // The quarantine removes the bands of the worker "wrong" from the job. So the coordinator reads
    // the log again and adds up the bands of the other workers.
    ASSERT_TRUE(quarantine("wrong").ok());
    std::string why;
    while (why.find("damaged on the coordinator's disk") == std::string::npos) {
      why = absl::StrJoin(farm_.why(job), "\n");
    }
  }
  void render_the_rest(JobId job) {
    FakeWorker right(farm_.scene(), "right");
    right.join(farm_.engine());
    EXPECT_TRUE(tell(&Engine::resume, job).ok());
    expect_right_image(job);
  }
  void expect_right_image(JobId job) {
    const JobView view = farm_.wait_final(job);
    ASSERT_EQ(view.state, JobState::kDone) << view.reason;
    EXPECT_EQ(view.samples_done, std::uint64_t{20} * 14 * kSamples)  // 20 x 14 pixels
        << "no sample must be lost or counted twice";
    const absl::StatusOr<StoredResult> result = farm_.result(job);
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(result->image.pixels, farm_.local(kSamples).pixels);
  }

  TestFarm farm_;
};

TEST_P(DamagedLog, BandsAreRenderedAgainIfDamageIsFoundWhileTheCoordinatorRuns) {
  const JobId job = begin_and_render_a_part();
  ASSERT_NO_FATAL_FAILURE(do_damage(farm_.bands_file(job), GetParam()));
  ASSERT_NO_FATAL_FAILURE(find_damage(job));
  render_the_rest(job);
}

TEST_P(DamagedLog, BandsAreRenderedAgainIfDamageIsFoundAtARestart) {
  const JobId job = begin_and_render_a_part();
  farm_.stop();
  ASSERT_NO_FATAL_FAILURE(do_damage(farm_.bands_file(job), GetParam()));
  ASSERT_TRUE(farm_.start().ok());
  render_the_rest(job);
}

TEST_P(DamagedLog, BandsRenderedAgainSurviveARestart) {
  const JobId job = begin_and_render_a_part();
  ASSERT_NO_FATAL_FAILURE(do_damage(farm_.bands_file(job), GetParam()));
  ASSERT_NO_FATAL_FAILURE(find_damage(job));
  render_some(job, "some");
  const std::uint64_t samples_before = farm_.view(job).samples_done;
  farm_.stop();
  ASSERT_TRUE(farm_.start().ok());
  EXPECT_EQ(farm_.view(job).samples_done, samples_before);
  render_the_rest(job);
}

INSTANTIATE_TEST_SUITE_P(All, DamagedLog,
                         testing::Values(Damage::kFlippedByte, Damage::kCutTail, Damage::kNoFile));

}  // namespace
}  // namespace bandsaw::coordinator
