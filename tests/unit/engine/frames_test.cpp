// A sequence (a job of many frames) in the whole engine, with real pixels and over a restart.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "coordinator/engine/blocking_call.h"
#include "tests/unit/engine/fake_worker.h"
#include "tests/unit/engine/test_farm.h"

namespace bandsaw::coordinator {
namespace {

using testing::HasSubstr;

constexpr std::uint64_t kSamples = 48;

std::vector<FrameView> frames_of(Engine& engine, JobId sequence) {
  using Frames = absl::StatusOr<std::vector<FrameView>>;
  const Frames frames =
      blocking_call<Frames>([&](auto answer) { engine.frames(sequence, /*after=*/0, answer); });
  EXPECT_TRUE(frames.ok()) << frames.status();
  return frames.value_or(std::vector<FrameView>());
}

/// Submits frames 1 to `count`, all with the scene of the farm.
JobId begin(TestFarm& farm, FrameNumber count) {
  SequenceSpec spec;
  spec.request_id = "a sequence of frames";
  spec.name = "walk";
  spec.settings = farm.settings();
  spec.stop = StopAtSamples{kSamples};
  spec.fixed_seed = true;  // so every frame has the pixels of the same local render
  std::vector<FrameScene> scenes;
  const DigestHex manifest = farm.send_package();
  for (FrameNumber frame = 1; frame <= count; ++frame) {
    spec.frames.push_back(frame);
    scenes.push_back({frame, manifest});
  }
  using Id = absl::StatusOr<JobId>;
  const Id id =
      blocking_call<Id>([&](auto answer) { farm.engine().submit_sequence(spec, answer); });
  EXPECT_TRUE(id.ok()) << id.status();
  using View = absl::StatusOr<JobView>;
  const View added =
      blocking_call<View>([&](auto answer) { farm.engine().add_frames(*id, scenes, answer); });
  EXPECT_TRUE(added.ok()) << added.status();
  return *id;
}

TEST(EngineFrames, EachFrameHasItsImageAfterARestartAndIsRenderedOnce) {
  TestFarm farm;
  ASSERT_TRUE(farm.start().ok());
  const JobId id = begin(farm, 8);
  {
    FakeWorker one(farm.scene(), "one");
    one.join(farm.engine());
    farm.wait_until(id, [](const JobView& view) { return view.frames.of(FrameState::kDone) >= 3; });
  }
  farm.stop();
  ASSERT_TRUE(farm.start().ok());
  std::map<FrameNumber, JobId> done;
  for (const FrameView& frame : frames_of(farm.engine(), id)) {
    if (frame.state == FrameState::kDone) {
      done[frame.number] = frame.job;
    }
  }
  EXPECT_GE(done.size(), 3u);
  FakeWorker two(farm.scene(), "two");
  two.join(farm.engine());
  EXPECT_EQ(farm.wait_final(id).state, JobState::kDone);
  for (const FrameView& frame : frames_of(farm.engine(), id)) {
    ASSERT_EQ(frame.state, FrameState::kDone);
    const auto result = farm.result(frame.job);
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(result->image.pixels, farm.local(kSamples).pixels);
    if (done.contains(frame.number)) {
      EXPECT_EQ(done[frame.number], frame.job) << "a frame that was done must keep its job";
    }
  }
  // The list of jobs has the sequence, but not the jobs of its frames.
  const auto jobs =
      blocking_call<std::vector<JobView>>([&](auto answer) { farm.engine().jobs(answer); });
  EXPECT_EQ(jobs.size(), 1u);
  EXPECT_THAT(std::string(farm.result(id).status().message()), HasSubstr("has frames"));
}

TEST(EngineFrames, TheErrorOfASceneWithMissingBlobsNamesTheFrame) {
  TestFarm farm;
  ASSERT_TRUE(farm.start().ok());
  const JobId id = begin(farm, 2);
  using View = absl::StatusOr<JobView>;
  const View missing = blocking_call<View>([&](auto answer) {
    farm.engine().add_frames(id, {{2, DigestHex(64, 'e')}}, answer);
  });
  EXPECT_EQ(missing.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(missing.status().message()),
              HasSubstr("frame 2: the package's manifest"));
  // A job that is not a sequence has no list of frames.
  const JobId single = farm.begin(StopAtSamples{1});
  using Frames = absl::StatusOr<std::vector<FrameView>>;
  EXPECT_EQ(
      blocking_call<Frames>([&](auto answer) { farm.engine().frames(single, /*after=*/0, answer); })
          .status()
          .code(),
      absl::StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace bandsaw::coordinator
