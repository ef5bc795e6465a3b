// The additional jobs that a denoised ("clean") image needs. Two jobs render its guides, which are
// images of the albedo and of the shape of the surfaces. If the image has at most one block of 8
// samples, a third job renders further samples with another seed.

#include "coordinator/scheduler/api/clean_jobs.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

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
  EXPECT_EQ(many.albedo.stop, StopRule(StopAtSamples{16}));
  EXPECT_EQ(many.shape.stop, StopRule(StopAtSamples{8}));
  EXPECT_EQ(many.albedo.settings.seed, 3u);
  EXPECT_FALSE(many.further);
  const CleanJobs few = clean_jobs(job(), 7);
  EXPECT_EQ(few.albedo.stop, StopRule(StopAtSamples{7}));
  EXPECT_EQ(few.shape.stop, StopRule(StopAtSamples{4}));
  ASSERT_TRUE(few.further);
  EXPECT_EQ(few.further->stop, StopRule(StopAtSamples{3}));
  EXPECT_NE(few.further->settings.seed, 3u) << "the samples must be independent";
  EXPECT_FALSE(clean_jobs(job(), 9).further) << "9 samples are two blocks";
  EXPECT_EQ(few.further->settings.integrator, Integrator::kPath);
}

// The quarter is rounded down to a power of two and limited to 8 to 32 samples. The guides never
// have more samples than the image.
TEST(CleanJobs, TheAlbedoHasAQuarterOfTheSamplesWithinBoundsAndTheShapeHalfOfThat) {
  const std::map<std::uint64_t, std::pair<std::uint64_t, std::uint64_t>> expected = {
      {1, {1, 1}},  {3, {3, 3}},   {7, {7, 4}},    {8, {8, 4}},     {16, {8, 4}},
      {63, {8, 4}}, {64, {16, 8}}, {127, {16, 8}}, {128, {32, 16}}, {1 << 20, {32, 16}}};
  for (const auto& [samples, of_guides] : expected) {
    EXPECT_EQ(guide_samples(samples).albedo, of_guides.first) << samples;
    EXPECT_EQ(guide_samples(samples).shape, of_guides.second) << samples;
  }
}

// Jobs with the same request id are one job. The guides of an image of 128 or 4,096 samples have 32
// samples, and the guides of an image of 127 samples have 16.
TEST(CleanJobs, AreTheSameForAllImagesThatNeedThem) {
  JobSpec other = job();
  other.request_id = "fedcba9876543210";
  other.name = "another name";
  other.stop = StopAtTime{5};
  const CleanJobs jobs = clean_jobs(job(), 128);
  EXPECT_EQ(clean_jobs(other, 4096).albedo.request_id, jobs.albedo.request_id);
  EXPECT_NE(jobs.shape.request_id, jobs.albedo.request_id);
  EXPECT_NE(clean_jobs(job(), 127).albedo.request_id, jobs.albedo.request_id);
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
