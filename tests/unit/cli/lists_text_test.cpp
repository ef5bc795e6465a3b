// Tests the tables and the JSON of `bandsaw jobs` and `bandsaw workers`, the exit codes of errors,
// and the messages of stop rules, which tell when a job is done.

#include "coordinator/cli/farm/lists_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/cli/farm/farm_errors.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Lists, JobsAreATableWithAlignedColumns) {
  farm::JobStatus status;
  status.set_job(7);
  status.set_name("cornell");
  status.set_state(farm::JOB_STATE_RUNNING);
  status.mutable_settings()->set_width(600);
  status.mutable_settings()->set_height(400);
  status.mutable_stop()->set_samples(64);
  status.set_fraction(0.255);
  status.set_priority(-5);
  status.set_elapsed_s(3);
  status.set_error(-1);
  EXPECT_THAT(
      jobs_table({progress_of(status)}),
      ElementsAre("job  scene    state    priority  done  size     until       error  time",
                  "7    cornell  running  -5        25 %  600×400  64 samples         3.0 s"));
  EXPECT_THAT(jobs_table({}), ElementsAre(HasSubstr("no jobs")));
}

// A guide is an image, such as the albedo, by which the denoiser finds edges. Each guide is
// rendered as a job of its own.
TEST(Lists, GuidesThatAreDoneAreCountedAndNotListed) {
  farm::JobStatus guide;
  guide.set_job(8);
  guide.set_name("cornell (guide: albedo)");
  guide.set_state(farm::JOB_STATE_RUNNING);
  guide.mutable_settings()->set_integrator(static_cast<farm::Integrator>(kGuideAlbedo));
  guide.mutable_stop()->set_samples(16);
  const Progress running = progress_of(guide);
  guide.set_state(farm::JOB_STATE_DONE);
  const Progress done = progress_of(guide);
  EXPECT_THAT(jobs_table({running, done, done}),
              ElementsAre(HasSubstr("job"), HasSubstr("guide: albedo"),
                          "not listed: 2 finished guide images for the denoiser"));
  EXPECT_EQ(jobs_json({running, done}).size(), 2u);
}

TEST(Lists, WorkersAreATable) {
  farm::ListWorkersReply reply;
  EXPECT_THAT(workers_table(reply), ElementsAre(HasSubstr("bandsaw-worker")));
  farm::WorkerStatus& worker = *reply.add_worker();
  worker.set_name("anna");
  worker.set_state("idle");
  worker.set_threads(4);
  EXPECT_EQ(workers_table(reply).size(), 2u);
  EXPECT_THAT(workers_json(reply).front(), HasSubstr("\"name\":\"anna\",\"kind\":\"native\""));
  reply.mutable_worker(0)->set_browser(true);
  EXPECT_THAT(workers_table(reply).back(), HasSubstr("anna    browser  idle"));
  EXPECT_THAT(workers_json(reply).front(), HasSubstr("\"kind\":\"browser\""));
}

TEST(FarmErrors, MapToExitCodes) {
  EXPECT_EQ(exit_code_of(absl::UnavailableError("")), ExitCode::kNoFarm);
  EXPECT_EQ(exit_code_of(absl::InvalidArgumentError("")), ExitCode::kWrong);
  EXPECT_EQ(exit_code_of(absl::UnauthenticatedError("")), ExitCode::kWrong);
  EXPECT_EQ(exit_code_of(absl::NotFoundError("")), ExitCode::kFailed);
  EXPECT_EQ(exit_code_of(absl::CancelledError("")), ExitCode::kInterrupted);
}

TEST(Progress, StopRulesRoundTrip) {
  for (const StopRule& stop :
       {StopRule(StopAtSamples{5}), StopRule(StopAtError{.relative_rmse = 0.02}),
        StopRule(StopAtTime{.seconds = 9})}) {
    farm::JobStatus status;
    *status.mutable_stop() = to_message(stop);
    EXPECT_EQ(progress_of(status).job.spec.stop, stop);
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
