// The conversion between the coordinator's types and protobuf messages loses nothing in either
// direction.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/convert/farm_messages.h"
#include "proto/convert/render_values.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;

const RenderSettings kSettings{
    .width = 3, .height = 4, .max_depth = 5, .seed = ~0ull, .integrator = Integrator::kDepth};

const Counters kCounters{.rays = 1,
                         .bad_samples = 2,
                         .bad_x = 3,
                         .bad_y = 4,
                         .bad_sample = 5,
                         .negative_samples = 6,
                         .truncated_paths = 7,
                         .dropped_primitives = 8,
                         .techniques = 7,
                         .training_rays = 9};

TEST(Convert, SettingsRoundTrip) { EXPECT_EQ(settings_of(to_message(kSettings)), kSettings); }

TEST(Convert, BandsRoundTrip) {
  const Band band{.samples = {16, 32}, .rows = {7, 9}};
  EXPECT_EQ(band_of(to_message(band)), band);
}

TEST(Convert, CountersRoundTrip) { EXPECT_EQ(counters_of(to_message(kCounters)), kCounters); }

TEST(Convert, StopRulesRoundTrip) {
  const StopRule rules[] = {
      StopAtSamples{16}, StopAtError{.relative_rmse = 0.01, .max_samples = 77, .adaptive = true},
      StopAtError{.relative_rmse = 0.5}, StopAtTime{.seconds = 3, .max_samples = 4}};
  for (const StopRule& rule : rules) {
    const absl::StatusOr<StopRule> back = stop_rule_of(to_message(rule));
    ASSERT_TRUE(back.ok()) << back.status();
    EXPECT_EQ(*back, rule);
  }
}

TEST(Convert, TheErrorOfAnInvalidStopRuleNamesTheField) {
  farm::StopRule none;
  EXPECT_THAT(stop_rule_of(none).status().message(), HasSubstr("exactly one"));
  farm::StopRule adaptive;
  adaptive.set_samples(1);
  adaptive.set_adaptive(true);
  EXPECT_THAT(stop_rule_of(adaptive).status().message(), HasSubstr("stop.adaptive"));
  farm::StopRule many;
  many.set_samples(kMaxSamples + 1);
  EXPECT_THAT(stop_rule_of(many).status().message(), HasSubstr("stop.samples"));
}

TEST(Convert, ErrorPointsRoundTrip) {
  const ErrorPoint point{.samples = 16,
                         .elapsed_s = 1,
                         .cpu_s = 2,
                         .estimate = {.mean = 3,
                                      .rmse = 4,
                                      .relative_rmse = 5,
                                      .margin = 6,
                                      .relative_mse = 7,
                                      .median = 8,
                                      .percentile_95 = 9,
                                      .percentile_99 = 10,
                                      .worst_share = 11}};
  EXPECT_EQ(error_point_of(to_message(point)), point);
}

/// Returns a job that sets every field of its message, farm::JobStatus.
JobView full_job() {
  JobView job;
  job.id = 1;
  job.spec = {.request_id = "",
              .name = "name",
              .manifest = std::string(64, 'a'),
              .settings = kSettings,
              .stop = StopAtTime{.seconds = 2, .max_samples = 3}};
  job.spec.sequence = 16;
  job.spec.frame = -17;
  job.frames = {{18, 19, 20, 21, 22}};
  job.state = JobState::kFailed;
  job.reason = "reason";
  job.fraction = 0.5;
  job.elapsed_s = 6;
  job.remaining_s = 7;
  job.samples_per_s = 8;
  job.samples_done = 9;
  job.samples_per_pixel = 10;
  job.error = 11;
  job.counters = kCounters;
  job.cpu_s = 12;
  job.workers_used = 13;
  job.priority = -14;
  job.log_of = "desk";
  job.log = {"one", "two"};
  job.bands_audited = 15;
  job.workers = {
      {.name = "desk", .threads = 2, .samples_per_s = 3, .rows = {4, 5}, .state = "rendering"}};
  job.curve = {{.samples = 16, .elapsed_s = 1, .cpu_s = 2, .estimate = {}}};
  job.shares = {{.name = "desk", .samples = 1, .cpu_s = 2}};
  return job;
}

// Converts a job to a message, back to a job, and to a message again. The two messages differ if
// job_view_of() forgets a field. EveryFieldOfAJobIsSet finds the fields that to_message() forgets.
TEST(Convert, JobsRoundTrip) {
  const JobView job = full_job();
  const farm::JobStatus message = to_message(job);
  const JobView back = job_view_of(message);
  farm::JobStatus again = to_message(back);
  EXPECT_EQ(message.bad_sample_at(), "pixel (3, 4), sample 5");
  again.set_bad_sample_at(message.bad_sample_at());  // a text, which job_view_of() does not read
  EXPECT_EQ(again.SerializeAsString(), message.SerializeAsString());
  EXPECT_EQ(back.spec, job.spec);
  EXPECT_EQ(back.bands_audited, 15u);
  EXPECT_EQ(back.frames, job.frames);
  EXPECT_EQ(back.counters.truncated_paths, job.counters.truncated_paths);
  EXPECT_EQ(back.workers[0].rows, job.workers[0].rows);
  EXPECT_EQ(back.log, job.log);
}

TEST(Convert, AJobInAListHasAShortReason) {
  JobView job = full_job();
  job.reason = std::string(2'000, 'x');
  EXPECT_EQ(to_list_entry(job).reason(), std::string(300, 'x'));
  EXPECT_EQ(to_message(job).reason(), job.reason);
}

TEST(Convert, EveryFieldOfAJobIsSet) {
  const farm::JobStatus message = to_message(full_job());
  const google::protobuf::Descriptor* type = message.GetDescriptor();
  std::vector<const google::protobuf::FieldDescriptor*> set;
  message.GetReflection()->ListFields(message, &set);
  for (int i = 0; i < type->field_count(); ++i) {
    EXPECT_THAT(set, ::testing::Contains(type->field(i))) << type->field(i)->name();
  }
}

TEST(Convert, EveryFieldOfAWorkerIsSet) {
  const farm::WorkerStatus message = to_message(WorkerView{.name = "desk",
                                                           .state = "idle",
                                                           .reason = "reason",
                                                           .address = "::1",
                                                           .build = "build",
                                                           .threads = 1,
                                                           .samples_per_s = 2,
                                                           .job = 3,
                                                           .connected_s = 4,
                                                           .browser = true});
  std::vector<const google::protobuf::FieldDescriptor*> set;
  message.GetReflection()->ListFields(message, &set);
  EXPECT_EQ(static_cast<int>(set.size()), message.GetDescriptor()->field_count());
}

TEST(Convert, EveryStateRoundTrips) {
  for (const JobState state : {JobState::kRunning, JobState::kPaused, JobState::kFinishing,
                               JobState::kDone, JobState::kFailed, JobState::kCancelled}) {
    JobView job;
    job.state = state;
    EXPECT_EQ(job_view_of(to_message(job)).state, state);
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
