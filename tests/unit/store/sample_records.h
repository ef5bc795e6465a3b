#pragma once

// Sample data for tests of the journal: at least one record of every kind. The records have
// values that are difficult to write as text: control characters, and the limits of number types.

#include <limits>
#include <vector>

#include "coordinator/scheduler/api/messages.h"

namespace bandsaw::coordinator {

/// Returns a job with this stop rule. Its name contains zero bytes, so the length, 39, is given.
inline JobSpec sample_spec(StopRule stop) {
  return {.request_id = "0123456789abcdef",
          .name = std::string("a \"name\"\n with\ttabs, \xc3\xa4 and a \0 inside", 39),
          .manifest = std::string(64, 'a'),
          .settings = {.width = kMaxSide, .height = 1, .max_depth = kMaxDepth, .seed = UINT64_MAX},
          .stop = stop,
          .package_bytes = 12'345};
}

/// Returns a sequence, which is a job of many frames.
inline SequenceSpec sample_sequence() {
  const JobSpec job = sample_spec(StopAtError{.relative_rmse = 0.1, .max_samples = 9});
  return {.request_id = job.request_id,
          .name = job.name,
          .settings = job.settings,
          .stop = job.stop,
          .fixed_seed = true,
          .frames = {-1'000'000'000, -3, -2, 0, 7, 9, 11, 1'000'000'000}};
}

/// Returns the job of frame -2 of the sequence with id 4.
inline JobSpec sample_frame_job() {
  JobSpec job = sample_spec(StopAtSamples{.samples = 1});
  job.sequence = 4;
  job.frame = -2;
  return job;
}

inline std::vector<Record> sample_records() {
  return {record::JobAdded{.job = 1, .spec = sample_spec(StopAtSamples{.samples = 256})},
          record::JobAdded{
              .job = 2, .spec = sample_spec(StopAtError{.relative_rmse = 0.1, .max_samples = 9})},
          record::JobAdded{.job = UINT64_MAX,
                           .spec = sample_spec(StopAtTime{.seconds = 1e-300, .max_samples = 1})},
          record::PassPlanned{.job = 1, .samples = {.first = 16, .last = 32}},
          record::JobAdded{.job = 2,
                           .spec = sample_spec(StopAtError{
                               .relative_rmse = 0.1, .max_samples = 9, .adaptive = true})},
          record::TilesPlanned{.job = 2, .plan = {.pilot = 64, .levels = "0123456789abcdef"}},
          record::SamplesFixed{.job = 1, .samples = kMaxSamples},
          record::StateChanged{.job = 1, .state = JobState::kRunning, .reason = ""},
          record::StateChanged{.job = 1, .state = JobState::kPaused, .reason = "the disk\nis full"},
          record::StateChanged{.job = 1, .state = JobState::kFinishing, .reason = ""},
          record::StateChanged{.job = 1, .state = JobState::kDone, .reason = ""},
          record::StateChanged{.job = 1, .state = JobState::kFailed, .reason = " "},
          record::StateChanged{.job = 1, .state = JobState::kCancelled, .reason = "by\\user"},
          record::PriorityChanged{.job = 1, .priority = -kMaxPriority},
          record::HoldChanged{.job = 1, .held = true},
          record::TimeSpent{.job = 1, .elapsed_s = 1e-3},
          record::JobSummary{.job = 1,
                             .elapsed_s = 3.25,
                             .cpu_s = 1.0 / 3,
                             .workers_used = UINT32_MAX,
                             .samples = UINT64_MAX,
                             .samples_per_pixel = 7,
                             .error = -1,
                             .counters = {.rays = 9,
                                          .bad_samples = 8,
                                          .bad_x = 7,
                                          .bad_y = UINT32_MAX,
                                          .bad_sample = 5,
                                          .negative_samples = 4,
                                          .truncated_paths = 3,
                                          .dropped_primitives = UINT64_MAX,
                                          .techniques = 3,
                                          .training_rays = 2}},
          record::ErrorMeasured{.job = 1,
                                .point = {.samples = kMaxSamples,
                                          .elapsed_s = 1.5,
                                          .cpu_s = 1e9,
                                          .estimate = {.mean = 1e-300,
                                                       .rmse = 2.0 / 3,
                                                       .relative_rmse = 0.1,
                                                       .margin = 0.02,
                                                       .relative_mse = 1e300,
                                                       .median = 0,
                                                       .percentile_95 = 1,
                                                       .percentile_99 = 2,
                                                       .worst_share = 0.3}}},
          record::ShareCounted{
              .job = 1,
              .share = {.process = UINT64_MAX, .name = "a\nb", .samples = UINT64_MAX, .cpu_s = 0}},
          record::FailureLog{.job = 1, .worker = "desk", .log = {"one \\ line", "another"}},
          record::JobForgotten{.job = 3},
          record::WorkerJoined{.instance = "0123456789abcdef0123456789abcdef"},
          record::WorkerJoined{.instance = "tab", .browser = true},
          record::WorkerLeft{.instance = ""},
          record::BandAudited{.job = 1, .band = {{16, 32}, {3, UINT32_MAX}}, .process = 7},
          record::BandLost{.job = 1, .band = {{0, 16}, {0, UINT32_MAX}}, .process = UINT64_MAX},
          record::RowDisputed{.job = 1,
                              .band = {{0, 16}, {3, 4}},
                              .stored = {.process = UINT64_MAX, .machine = "a desk", .digest = 5},
                              .other = {.process = 7, .machine = "", .digest = UINT64_MAX}},
          record::ErrorForgotten{.job = 1},
          record::WorkerQuarantined{.process = UINT64_MAX, .name = "a desk", .reason = "lied\n"},
          record::WorkerQuarantined{
              .process = 6, .name = "tab@browser", .reason = "lied", .browser = true},
          record::QuarantineLifted{.name = "a desk"},
          record::SequenceAdded{.job = 4, .spec = sample_sequence(), .pixel_version = UINT32_MAX},
          record::FrameWaits{.job = 4,
                             .frame = -1'000'000'000,
                             .manifest = std::string(64, 'b'),
                             .package_bytes = UINT64_MAX,
                             .failures = 1,
                             .reason = "the mesh\nis broken"},
          record::JobAdded{.job = 5, .spec = sample_frame_job()}};
}

}  // namespace bandsaw::coordinator
