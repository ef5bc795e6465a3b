// The whole engine with fake workers in threads: images have the bytes of a local render, and
// invalid requests and bands are refused. A band is a range of samples of a range of rows. A job is
// rendered in passes. A pass renders a range of samples in all rows of the image.

#include "coordinator/engine/engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>

#include "renderlib/render/render_band.h"
#include "renderlib/render/work_hash.h"
#include "tests/unit/engine/fake_worker.h"
#include "tests/unit/engine/test_farm.h"

namespace bandsaw::coordinator {
namespace {

using testing::HasSubstr;

/// The image of the farm has 14 rows of 20 pixels.
class EngineTest : public testing::Test {
 protected:
  EngineTest() { EXPECT_TRUE(farm_.start().ok()); }

  /// Renders a band of the farm's scene, as a worker does.
  BandPixels rendered(const Band& band) {
    Pool pool(1);
    const std::atomic<bool> stop{false};
    return *render_band(*farm_.scene(), farm_.settings(), band, pool, stop, [](std::uint32_t) {});
  }
  /// Waits for the end of the job. Expects that it is done, has `samples` samples per pixel and has
  /// the pixels of a local render.
  void expect_done(JobId job, std::uint64_t samples) {
    const JobView view = farm_.wait_final(job);
    EXPECT_EQ(view.state, JobState::kDone) << view.reason;
    EXPECT_EQ(view.samples_per_pixel, samples);
    const absl::StatusOr<StoredResult> result = farm_.result(job);
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(result->image.pixels, farm_.local(samples).pixels);
  }

  TestFarm farm_;
};

TEST_F(EngineTest, OneWorkerRendersTheSameImageAsALocalRender) {
  FakeWorker worker(farm_.scene(), "one");
  worker.join(farm_.engine());
  expect_done(farm_.begin(StopAtSamples{.samples = 40}), 40);
}

TEST_F(EngineTest, ManyWorkersThatJoinAndLeaveRenderTheSameImage) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 128});
  std::atomic<int> stored{0};
  const auto count = [&](const Band&, const absl::StatusOr<BandOutcome>& outcome) {
    stored += outcome.ok() && *outcome == BandOutcome::kStored ? 1 : 0;
  };
  FakeWorker first(farm_.scene(), "first", count);
  FakeWorker second(farm_.scene(), "second", count);
  FakeWorker third(farm_.scene(), "third", count);
  first.join(farm_.engine());
  second.join(farm_.engine());
  farm_.wait_until(job, [](const JobView& view) { return view.samples_done > 0; });
  first.leave();
  third.join(farm_.engine());
  first.join(farm_.engine());
  second.leave();
  expect_done(job, 128);
  EXPECT_GT(stored, 0);
}

TEST_F(EngineTest, AnErrorRuleEndsTheJobAtAPassThatReachesTheError) {
  FakeWorker worker(farm_.scene(), "one");
  worker.join(farm_.engine());
  const JobId job = farm_.begin(StopAtError{.relative_rmse = 0.2, .max_samples = 4096});
  const JobView view = farm_.wait_final(job);
  ASSERT_EQ(view.state, JobState::kDone) << view.reason;
  EXPECT_GT(view.error, 0);
  EXPECT_LE(view.error, 0.2);
  EXPECT_EQ(farm_.result(job)->image.pixels, farm_.local(view.samples_per_pixel).pixels);
}

TEST_F(EngineTest, ATimeRuleEndsTheJobAtACompletePass) {
  FakeWorker worker(farm_.scene(), "one");
  FakeWorker other(farm_.scene(), "other");
  worker.join(farm_.engine());
  other.join(farm_.engine());
  const JobId job = farm_.begin(StopAtTime{.seconds = 0.3, .max_samples = 1u << 16});
  const JobView view = farm_.wait_final(job);
  ASSERT_EQ(view.state, JobState::kDone) << view.reason;
  EXPECT_EQ(farm_.result(job)->image.pixels, farm_.local(view.samples_per_pixel).pixels);
}

TEST_F(EngineTest, ARepeatedRequestReturnsTheSameJob) {
  const JobSpec spec = farm_.spec(StopAtSamples{.samples = 8});
  EXPECT_EQ(*farm_.submit(spec), *farm_.submit(spec));
}

TEST_F(EngineTest, AMissingBlobIsNamedBeforeAnythingIsRendered) {
  JobSpec spec = farm_.spec(StopAtSamples{.samples = 8});
  spec.manifest = std::string(64, '7');
  const absl::Status status = farm_.submit(spec).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(status.message()), HasSubstr(spec.manifest));
}

TEST_F(EngineTest, SettingsOutOfRangeAreRefused) {
  const JobSpec good = farm_.spec(StopAtSamples{.samples = 8});
  JobSpec bad = good;
  bad.settings.width = 0;
  EXPECT_EQ(farm_.submit(bad).status().code(), absl::StatusCode::kInvalidArgument);
  bad = good;
  bad.stop = StopAtSamples{.samples = 0};
  EXPECT_EQ(farm_.submit(bad).status().code(), absl::StatusCode::kInvalidArgument);
  bad.stop = StopAtError{.relative_rmse = 0};
  EXPECT_EQ(farm_.submit(bad).status().code(), absl::StatusCode::kInvalidArgument);
  bad.stop = StopAtTime{.seconds = -1};
  EXPECT_EQ(farm_.submit(bad).status().code(), absl::StatusCode::kInvalidArgument);
  bad = good;
  bad.request_id = "short";
  EXPECT_EQ(farm_.submit(bad).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST_F(EngineTest, ANameWithControlCharactersOrBadUtf8IsRefused) {
  JobSpec spec = farm_.spec(StopAtSamples{.samples = 8});
  for (const std::string name : {"two\nlines", "\x1b[31mred", "half of an \xc3"}) {
    spec.name = name;
    const absl::Status status = farm_.submit(spec).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << name;
    EXPECT_THAT(std::string(status.message()), HasSubstr("UTF-8 without control characters"));
  }
  spec.name = "Größe 世界";
  EXPECT_TRUE(farm_.submit(spec).ok());
}

TEST_F(EngineTest, BandsOfABrowserThatHasNotJoinedAreRefused) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  const BandPixels top = rendered({.samples = {0, 8}, .rows = {0, 8}});
  EXPECT_EQ(farm_.put(job, top, /*work=*/0, /*browser=*/true).status().code(),
            absl::StatusCode::kFailedPrecondition)
      << "no browser has joined";
  EXPECT_EQ(*farm_.put(job, top), BandOutcome::kStored);
}

TEST_F(EngineTest, ARepeatedBandIsADuplicateAndAfterTheJobItIsUnwanted) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  const BandPixels top = rendered({.samples = {0, 8}, .rows = {0, 7}});
  EXPECT_EQ(*farm_.put(job, top), BandOutcome::kStored);
  EXPECT_EQ(*farm_.put(job, top), BandOutcome::kDuplicate);
  const BandPixels more = rendered({.samples = {0, 8}, .rows = {5, 10}});
  EXPECT_EQ(*farm_.put(job, more), BandOutcome::kStored) << "some rows of the band are new";
  EXPECT_EQ(*farm_.put(job, rendered({.samples = {0, 8}, .rows = {10, 14}})), BandOutcome::kStored);
  expect_done(job, 8);
  EXPECT_EQ(*farm_.put(job, top), BandOutcome::kUnwanted);
  EXPECT_EQ(*farm_.put(job + 1, top), BandOutcome::kUnwanted) << "there is no such job";
}

// The work hash is computed from the scene and the settings. It shows whether a band was rendered
// for another job.
TEST_F(EngineTest, ABandOfAnEarlierJobWithTheSameIdIsUnwanted) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  const BandPixels top = rendered({.samples = {0, 8}, .rows = {0, 7}});
  JobSpec spec = farm_.spec(StopAtSamples{.samples = 8});
  EXPECT_EQ(*farm_.put(job, top, work_hash(spec.manifest, spec.settings) + 1),
            BandOutcome::kUnwanted);
  EXPECT_EQ(*farm_.put(job, top, work_hash(spec.manifest, spec.settings)), BandOutcome::kStored);
}

TEST_F(EngineTest, ABandThatDoesNotFitTheImageIsRefused) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  BandPixels band = rendered({.samples = {0, 8}, .rows = {0, 2}});
  band.sums.pop_back();
  EXPECT_EQ(farm_.put(job, band).status().code(), absl::StatusCode::kInvalidArgument);
  band = rendered({.samples = {0, 8}, .rows = {0, 2}});
  band.band.rows = {13, 15};
  EXPECT_EQ(farm_.put(job, band).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST_F(EngineTest, OnlyADoneJobHasAResult) {
  EXPECT_EQ(farm_.result(99).status().code(), absl::StatusCode::kNotFound);
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  EXPECT_EQ(farm_.result(job).status().code(), absl::StatusCode::kFailedPrecondition);
}

TEST_F(EngineTest, ACancelledJobIsFinalAndItsBandsAreGone) {
  const JobId job = farm_.begin(StopAtSamples{.samples = 8});
  ASSERT_TRUE(farm_.put(job, rendered({.samples = {0, 8}, .rows = {0, 7}})).ok());
  const std::string bands = farm_.folder() + "/jobs/" + std::to_string(job) + "/bands";
  EXPECT_TRUE(std::filesystem::exists(bands));
  const auto box = std::make_shared<Box<absl::StatusOr<JobView>>>();
  farm_.engine().cancel(job, [box](absl::StatusOr<JobView> view) { box->put(std::move(view)); });
  EXPECT_EQ(box->take()->state, JobState::kCancelled);
  EXPECT_EQ(farm_.wait_final(job).state, JobState::kCancelled);
  farm_.stop();
  ASSERT_TRUE(farm_.start().ok());
  EXPECT_FALSE(std::filesystem::exists(bands));
  EXPECT_EQ(farm_.wait_final(job).state, JobState::kCancelled)
      << "the job must still be cancelled after a restart";
}

TEST_F(EngineTest, WatchingAnUnknownJobIsNotFound) {
  const auto box = std::make_shared<Box<absl::Status>>();
  farm_.engine().watch(99, [box](absl::StatusOr<JobView> view) {
    box->put(view.status());
    return true;
  });
  EXPECT_EQ(box->take().code(), absl::StatusCode::kNotFound);
}

TEST_F(EngineTest, ASecondEngineOnTheFolderIsRefused) {
  const absl::Status second = Engine::start({.data_folder = farm_.folder()}).status();
  EXPECT_EQ(second.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(second.message()), HasSubstr(farm_.folder()));
}

}  // namespace
}  // namespace bandsaw::coordinator
