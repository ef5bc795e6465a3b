// The additional jobs that a denoised ("clean") image needs. Two jobs render its guides, which are
// images of the albedo and of the shape of the surfaces. If the image has at most one block of 8
// samples, a third job renders further samples with another seed.

#include "coordinator/scheduler/api/clean_jobs.h"

#include <gtest/gtest.h>

#include "renderlib/scene/guide_integrators.h"

namespace bandsaw::coordinator {
namespace {

JobSpec job() {
  return {.request_id = "0123456789abcdef",
          .name = "cornell",
          .manifest = std::string(64, 'a'),
          .settings = {.width = 8, .height = 4, .seed = 3},
          .stop = StopAtSamples{64}};
}

TEST(CleanJobs, AreTwoGuidesAndAThirdJobForAnImageOfOneBlock) {
  const CleanJobs many = clean_jobs(job(), 64);
  EXPECT_EQ(many.albedo.settings.integrator, kGuideAlbedo);
  EXPECT_EQ(many.shape.settings.integrator, kGuideShape);
  EXPECT_EQ(many.albedo.stop, StopRule(StopAtSamples{1}));
  EXPECT_EQ(many.shape.stop, StopRule(StopAtSamples{1}));
  EXPECT_EQ(many.albedo.settings.seed, 3u);
  EXPECT_FALSE(many.further);
  const CleanJobs few = clean_jobs(job(), 7);
  EXPECT_EQ(few.albedo.stop, StopRule(StopAtSamples{1}));
  EXPECT_EQ(few.shape.stop, StopRule(StopAtSamples{1}));
  ASSERT_TRUE(few.further);
  EXPECT_EQ(few.further->stop, StopRule(StopAtSamples{3}));
  EXPECT_NE(few.further->settings.seed, 3u) << "the samples must be independent";
  EXPECT_FALSE(clean_jobs(job(), 9).further) << "9 samples are two blocks";
  EXPECT_EQ(few.further->settings.integrator, Integrator::kPath);
}

// Jobs with the same request id are one job.
TEST(CleanJobs, AreTheSameForAllImagesThatNeedThem) {
  JobSpec other = job();
  other.request_id = "fedcba9876543210";
  other.name = "another name";
  other.stop = StopAtTime{5};
  const CleanJobs jobs = clean_jobs(job(), 128);
  EXPECT_EQ(clean_jobs(other, 3).albedo.request_id, jobs.albedo.request_id);
  EXPECT_NE(jobs.shape.request_id, jobs.albedo.request_id);
  other.settings.seed = 4;
  EXPECT_NE(clean_jobs(other, 128).albedo.request_id, jobs.albedo.request_id);
  EXPECT_GE(jobs.albedo.request_id.size(), 16u);
  EXPECT_LE(jobs.albedo.request_id.size(), 64u);
}

TEST(CleanJobs, HaveNamesThatAFarmAccepts) {
  JobSpec long_name = job();
  long_name.name = std::string(1, 'x');
  while (long_name.name.size() + 2 <= 200) {
    long_name.name += "é";
  }
  const std::string name = clean_jobs(long_name, 64).albedo.name;
  EXPECT_LE(name.size(), 200u);
  EXPECT_EQ(name.substr(name.find(" (")), " (guide: albedo)");
  EXPECT_EQ(name.find(" (") % 2, 1u);  // the name is not cut within an é, which has two bytes
}

TEST(CleanJobs, AreRefusedForASingleSampleAndForImagesWithoutNoise) {
  RenderSettings settings = job().settings;
  EXPECT_TRUE(check_cleanable(settings, 2).ok());
  EXPECT_FALSE(check_cleanable(settings, 1).ok());
  settings.integrator = Integrator::kDepth;
  EXPECT_FALSE(check_cleanable(settings, 64).ok());
}

}  // namespace
}  // namespace bandsaw::coordinator
