// Sequences (jobs of many frames): frames are given to workers as jobs of their own, tried again if
// they fail, and survive a restart.

#include <gmock/gmock.h>

#include <map>
#include <set>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/scheduler/api/frame_numbers.h"
#include "farm_driver.h"
#include "proto/wire/limits.h"
#include "renderlib/render/frame_seed.h"

namespace bandsaw::coordinator {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Returns a sequence of these frames, a list such as "1-20".
SequenceSpec test_sequence(const std::string& frames, std::uint32_t height = 64) {
  SequenceSpec spec;
  spec.request_id = "a sequence";
  spec.name = "walk";
  spec.settings.width = 64;
  spec.settings.height = height;
  spec.stop = StopAtSamples{8};
  spec.frames = *parse_frames(frames);
  return spec;
}

/// A farm whose workers render what they are leased, in turn.
class FrameFarm : public FarmDriver {
 public:
  using FarmDriver::FarmDriver;

  /// Submits a sequence and adds the scenes of all its frames.
  JobId submit_frames(const SequenceSpec& spec) {
    const JobId id = send(input::SubmitSequence{spec}).job;
    add(id, spec.frames);
    return id;
  }

  /// Adds the scenes of these frames to the sequence `id`.
  void add(JobId id, const std::vector<FrameNumber>& frames) {
    std::vector<FrameScene> scenes;
    for (const FrameNumber frame : frames) {
      scenes.push_back({frame, std::string(64, 'a')});
    }
    EXPECT_TRUE(send(input::AddFrames{id, scenes}).status.ok());
  }

  /// Does the next thing that the scheduler asked for: renders a lease, or writes an image. Returns
  /// false if there is none.
  bool work() {
    for (; next_ < actions.size(); ++next_) {
      const Action action = actions[next_];
      if (const auto* lease = std::get_if<action::Lease>(&action)) {
        ++next_;
        const std::string instance = instances.at(lease->session);
        sessions_of[lease->job].insert(lease->session);
        now += 0.02;
        if (fails.contains(lease->job)) {
          send(input::BandFailed{lease->session, lease->lease, "the mesh is broken", {}});
        } else {
          stored(*lease, instance, 0.1);
        }
        return true;
      }
      if (const auto* write = std::get_if<action::WriteResult>(&action)) {
        ++next_;
        ++results[write->job];
        send(input::ResultWritten{write->job});
        return true;
      }
    }
    return false;
  }

  void work_all() {
    while (work()) {
    }
  }

  void join(SessionId session, std::uint32_t max_bands = 1) {
    const std::string instance = std::string(1, static_cast<char>('a' + session));
    instances[session] = instance;
    hello(session, instance, max_bands);
  }

  std::vector<FrameView> frames(JobId id) const { return *scheduler.frames(id, 0); }
  std::vector<FrameNumber> in_state(JobId id, FrameState state) const {
    std::vector<FrameNumber> out;
    for (const FrameView& frame : frames(id)) {
      if (frame.state == state) {
        out.push_back(frame.number);
      }
    }
    return out;
  }
  /// Returns the job that renders a frame of the sequence `id`; 0: none.
  JobId job_of(JobId id, FrameNumber number) const {
    for (const FrameView& frame : frames(id)) {
      if (frame.number == number) {
        return frame.job;
      }
    }
    return 0;
  }

  std::map<SessionId, std::string> instances;        ///< instance of the worker of a session
  std::map<JobId, std::set<SessionId>> sessions_of;  ///< sessions that rendered bands of a job
  std::map<JobId, int> results;  ///< number of images that were written for a job
  std::set<JobId> fails;         ///< jobs whose bands fail

 private:
  std::size_t next_ = 0;
};

TEST(Sequences, AllFramesAreRenderedOnceAsOneJob) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-20"));
  farm.join(1);
  farm.join(2);
  farm.work_all();
  const JobView view = farm.job(id);
  EXPECT_EQ(view.state, JobState::kDone);
  EXPECT_EQ(view.frames.of(FrameState::kDone), 20u);
  EXPECT_EQ(view.fraction, 1);
  EXPECT_EQ(view.samples_done, 20u * 64 * 64 * 8);
  EXPECT_EQ(farm.results.size(), 20u);
  for (const auto& [job, times] : farm.results) {
    EXPECT_EQ(times, 1) << "of job " << job;
  }
  const std::vector<JobView> jobs = farm.scheduler.jobs(farm.now);
  ASSERT_EQ(jobs.size(), 1u);
  EXPECT_EQ(jobs.front().id, id);
  EXPECT_EQ(farm.scheduler.jobs(farm.now, {.after = id - 1, .most = 2}).size(), 1u);
  EXPECT_THAT(farm.scheduler.jobs(farm.now, {.after = id, .most = 2}), IsEmpty());
  EXPECT_THAT(farm.scheduler.why(id, farm.now), ElementsAre("it is done"));
}

TEST(Sequences, WholeFramesGoToWorkersWhileThereAreMany) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-30"));
  for (const SessionId session : {1, 2, 3}) {
    farm.join(session);
  }
  farm.work_all();
  std::size_t shared = 0;
  for (const FrameView& frame : farm.frames(id)) {
    shared += farm.sessions_of[frame.job].size() > 1 ? 1 : 0;
  }
  // The last three frames may be shared, because some workers then have no frame of their own.
  EXPECT_LE(shared, 3u);
}

TEST(Sequences, TheLastFrameIsRenderedByAllWorkersInBands) {
  FrameFarm farm(slow());
  const JobId id = farm.submit_frames(test_sequence("7"));
  for (const SessionId session : {1, 2, 3}) {
    farm.join(session);
  }
  farm.work_all();
  EXPECT_EQ(farm.sessions_of[farm.job_of(id, 7)].size(), 3u);
}

TEST(Sequences, AFrameThatFailsOnceIsRenderedAgainByAnotherJob) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-5"));
  const JobId first = farm.job_of(id, 3);
  farm.fails = {first};
  farm.join(1);
  farm.work_all();
  // The frame that failed was rendered again by another job, which succeeded.
  EXPECT_EQ(farm.job(id).state, JobState::kDone);
  EXPECT_NE(farm.job_of(id, 3), first);
  EXPECT_EQ(farm.results.size(), 5u);
}

TEST(Sequences, AFrameThatFailsTwiceFailsTheJobOnceTheOthersAreDone) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-5"));
  farm.join(1);
  // Each job that renders frame 3 fails.
  farm.fails = {farm.job_of(id, 3)};
  while (farm.work()) {
    if (farm.in_state(id, FrameState::kDone).size() < 5) {
      farm.fails.insert(farm.job_of(id, 3));
    }
  }
  EXPECT_THAT(farm.in_state(id, FrameState::kFailed), ElementsAre(3));
  EXPECT_EQ(farm.in_state(id, FrameState::kDone).size(), 4u);
  EXPECT_EQ(farm.job(id).state, JobState::kFailed);
  EXPECT_THAT(farm.job(id).reason, HasSubstr("frame 3 failed: "));
  EXPECT_THAT(farm.job(id).reason, HasSubstr("the mesh is broken"));
  EXPECT_THAT(farm.job(id).reason, HasSubstr("bandsaw retry 1"));

  EXPECT_EQ(farm.send(input::RetryFrames{id, {2}}).status.code(),
            absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(farm.send(input::RetryFrames{id, {9}}).status.code(),
            absl::StatusCode::kInvalidArgument);
  farm.fails.clear();
  ASSERT_TRUE(farm.send(input::RetryFrames{id, {}}).status.ok());
  EXPECT_EQ(farm.job(id).state, JobState::kRunning);
  farm.work_all();
  EXPECT_EQ(farm.job(id).state, JobState::kDone);
  EXPECT_EQ(farm.send(input::RetryFrames{id, {}}).status.code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST(Sequences, TheRemainingTimeOfARetryCountsOnlyItsFrames) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-20"));
  farm.join(1);
  do {
    farm.fails.insert(farm.job_of(id, 7));  // each job that renders frame 7 fails
  } while (farm.work());
  ASSERT_EQ(farm.job(id).state, JobState::kFailed);
  ASSERT_EQ(farm.in_state(id, FrameState::kDone).size(), 19u);
  ASSERT_TRUE(farm.send(input::RetryFrames{id, {}}).status.ok());
  farm.pass_time(1, {1});
  EXPECT_LT(farm.job(id).remaining_s, 0)
      << "the frames that were done before must not count, so the time is unknown";
}

TEST(Sequences, TheRemainingTimeIsUnknownInAPauseAndTheSameAfterIt) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-20"));
  farm.join(1);
  while (farm.in_state(id, FrameState::kDone).size() < 10) {
    ASSERT_TRUE(farm.work());
  }
  const JobView before = farm.job(id);
  ASSERT_GT(before.remaining_s, 0);
  farm.send(input::Pause{id});
  farm.pass_time(100, {1});
  EXPECT_NEAR(farm.job(id).elapsed_s, before.elapsed_s, 1e-6);
  EXPECT_LT(farm.job(id).remaining_s, 0);
  farm.send(input::Resume{id});
  EXPECT_NEAR(farm.job(id).elapsed_s, before.elapsed_s, 1e-6);
  EXPECT_NEAR(farm.job(id).remaining_s, before.remaining_s, 1e-6);
}

TEST(Sequences, TheRemainingTimeIsUnknownWhileScenesAreMissing) {
  FrameFarm farm;
  const JobId id = farm.send(input::SubmitSequence{test_sequence("1-4")}).job;
  farm.add(id, {1, 2});
  farm.join(1);
  farm.work_all();
  ASSERT_THAT(farm.in_state(id, FrameState::kDone), ElementsAre(1, 2));
  EXPECT_LT(farm.job(id).remaining_s, 0);
  farm.add(id, {3, 4});
  EXPECT_GT(farm.job(id).remaining_s, 0);
}

TEST(Sequences, TheReasonsOfTenFailedFramesAreTold) {
  const auto sentences = [](const std::string& frames) {
    FrameFarm farm;
    const JobId id = farm.submit_frames(test_sequence(frames));
    farm.join(1);
    do {
      for (const FrameView& frame : farm.frames(id)) {
        farm.fails.insert(frame.job);
      }
    } while (farm.work());
    return absl::StrJoin(farm.scheduler.why(id, farm.now), "\n");
  };
  EXPECT_THAT(sentences("1-10"),
              AllOf(HasSubstr("frame 10 failed: "), Not(HasSubstr("more frames failed"))));
  EXPECT_THAT(sentences("1-11"),
              AllOf(HasSubstr("frame 10 failed: "), Not(HasSubstr("frame 11 failed: ")),
                    HasSubstr("and more frames failed")));
}

TEST(Sequences, NoiseDiffersFromFrameToFrameUnlessItIsFixed) {
  FrameFarm farm;
  SequenceSpec spec = test_sequence("-1:2");
  spec.settings.seed = 5;
  const JobId id = farm.submit_frames(spec);
  spec.request_id = "another sequence";
  spec.fixed_seed = true;
  const JobId fixed = farm.submit_frames(spec);
  for (const FrameNumber frame : spec.frames) {
    EXPECT_EQ(farm.job(farm.job_of(id, frame)).spec.settings.seed, 5 + frame);
    EXPECT_EQ(farm.job(farm.job_of(fixed, frame)).spec.settings.seed, 5u);
  }
}

TEST(Sequences, FewOfManyFramesAreJobsAtATime) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-2000"));
  farm.join(1);
  std::size_t most = 0;
  for (int i = 0; i < 200 && farm.work(); ++i) {
    most = std::max(most, farm.in_state(id, FrameState::kRendering).size());
  }
  // With w workers, at most 2 w + 4 frames of a sequence are jobs at a time. Here w is 1.
  EXPECT_GE(most, 3u);
  EXPECT_LE(most, 6u);
  EXPECT_EQ(farm.scheduler.jobs(farm.now).size(), 1u);
}

TEST(Sequences, QueuedJobsDoNotHoldUpASequence) {
  FrameFarm farm;
  for (int i = 0; i < 500; ++i) {
    farm.send(input::Submit{test_job(absl::StrCat("still ", i), StopAtSamples{8}), -5});
  }
  const SequenceSpec spec = test_sequence("1-20");
  const JobId id = farm.send(input::SubmitSequence{spec, 100}).job;
  farm.add(id, spec.frames);
  farm.join(1);
  ASSERT_FALSE(farm.all<action::Lease>().empty());
  EXPECT_EQ(farm.job(farm.all<action::Lease>().front().job).spec.sequence, id);
}

TEST(Sequences, PausedSequencesDoNotHoldUpOthers) {
  FrameFarm farm;
  for (SessionId session = 1; session <= 60; ++session) {
    farm.hello(session, std::to_string(session), 1);
  }
  SequenceSpec spec = test_sequence("1-200");
  std::vector<JobId> paused;
  for (int i = 0; i < 5; ++i) {
    spec.request_id = absl::StrCat("paused ", i);
    paused.push_back(farm.submit_frames(spec));
  }
  for (const JobId id : paused) {
    ASSERT_TRUE(farm.send(input::Pause{id}).status.ok());
  }
  spec.request_id = "another";
  const JobId id = farm.submit_frames(spec);
  // Two frames for each of the 60 workers, and four more.
  EXPECT_EQ(farm.in_state(id, FrameState::kRendering).size(), 124u);
}

// At most 500 frame jobs are made for all sequences. With 39 workers, each of the six sequences has
// 4 + 2 x 39 of them, 492 in all. The next worker would need 12 more, and eight are left. They go
// to four sequences: the one with the highest priority, and the three oldest of the others.
TEST(Sequences, TheHighestPriorityGetsTheLastFrameJobs) {
  FrameFarm farm;
  SequenceSpec spec = test_sequence("1-200");
  std::vector<JobId> ids;
  for (int i = 0; i < 6; ++i) {
    spec.request_id = absl::StrCat("sequence ", i);
    ids.push_back(farm.send(input::SubmitSequence{spec, i == 5 ? 7 : 0}).job);
    farm.add(ids.back(), spec.frames);
  }
  for (SessionId session = 1; session <= 41; ++session) {
    farm.hello(session, std::to_string(session), 1);
  }
  EXPECT_EQ(farm.in_state(ids[5], FrameState::kRendering).size(), 84u);
  EXPECT_EQ(farm.in_state(ids[0], FrameState::kRendering).size(), 84u);
  EXPECT_EQ(farm.in_state(ids[4], FrameState::kRendering).size(), 82u);
  spec.request_id = "one more";
  const JobId more = farm.submit_frames(spec);
  EXPECT_EQ(farm.in_state(more, FrameState::kRendering).size(), 4u)
      << "each sequence must have at least four frame jobs";
}

TEST(Sequences, FramesWaitForTheirScenes) {
  FrameFarm farm;
  const JobId id = farm.send(input::SubmitSequence{test_sequence("1-4")}).job;
  farm.join(1);
  farm.work_all();
  EXPECT_EQ(farm.job(id).state, JobState::kRunning);
  EXPECT_THAT(farm.scheduler.why(id, farm.now).front(), HasSubstr("frames 1-4 expected"));
  farm.add(id, {2, 4});
  farm.work_all();
  EXPECT_THAT(farm.in_state(id, FrameState::kDone), ElementsAre(2, 4));
  EXPECT_EQ(farm.job(id).state, JobState::kRunning);
  farm.add(id, {1, 2, 3});  // frame 2 again, as after a lost answer
  farm.work_all();
  EXPECT_EQ(farm.job(id).state, JobState::kDone);
  EXPECT_EQ(farm.results.size(), 4u);
  EXPECT_EQ(farm.send(input::AddFrames{id, {{5, std::string(64, 'a')}}}).status.code(),
            absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(farm.send(input::AddFrames{99, {}}).status.code(), absl::StatusCode::kNotFound);
}

TEST(Sequences, TheSameRequestIdIsTheSameSequence) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-4"));
  EXPECT_EQ(farm.send(input::SubmitSequence{test_sequence("1-4")}).job, id);
  EXPECT_EQ(farm.send(input::SubmitSequence{test_sequence("1-5")}).status.code(),
            absl::StatusCode::kAlreadyExists);
}

TEST(Sequences, ArePausedResumedAndCancelledAsOneJob) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-20"));
  farm.join(1);
  for (int i = 0; i < 10; ++i) {
    farm.work();
  }
  ASSERT_TRUE(farm.send(input::Pause{id}).status.ok());
  EXPECT_EQ(farm.job(id).state, JobState::kPaused);
  farm.work_all();
  const std::size_t done = farm.in_state(id, FrameState::kDone).size();
  EXPECT_LT(done, 20u);
  ASSERT_TRUE(farm.send(input::Resume{id}).status.ok());
  ASSERT_TRUE(farm.send(input::SetPriority{id, 7}).status.ok());
  for (int i = 0; i < 6; ++i) {
    farm.work();
  }
  EXPECT_GT(farm.in_state(id, FrameState::kDone).size(), done);
  const std::vector<FrameNumber> open = farm.in_state(id, FrameState::kRendering);
  ASSERT_FALSE(open.empty());
  EXPECT_EQ(farm.job(farm.job_of(id, open.back())).priority, 7);
  ASSERT_TRUE(farm.send(input::Cancel{id}).status.ok());
  EXPECT_EQ(farm.job(id).state, JobState::kCancelled);
  EXPECT_THAT(farm.in_state(id, FrameState::kRendering), IsEmpty());
  farm.work_all();
  EXPECT_EQ(farm.send(input::RetryFrames{id, {}}).status.code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST(Sequences, ArePausedWhileAFullDiskPausesAllFrames) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-20"));
  farm.join(1);
  for (int i = 0; i < 10; ++i) {
    farm.work();
  }
  const std::vector<FrameNumber> open = farm.in_state(id, FrameState::kRendering);
  ASSERT_GT(open.size(), 1u);
  for (const FrameNumber frame : open) {
    EXPECT_EQ(farm.job(id).state, JobState::kRunning) << "before frame " << frame;
    farm.send(input::StorageFailed{farm.job_of(id, frame), "the disk is full"});
  }
  ASSERT_EQ(farm.in_state(id, FrameState::kRendering), open);
  EXPECT_EQ(farm.job(id).state, JobState::kPaused);
  EXPECT_EQ(farm.job(id).reason, "the disk is full");
  EXPECT_LT(farm.job(id).remaining_s, 0);
  farm.send(input::StorageBack{});
  EXPECT_EQ(farm.job(id).state, JobState::kRunning);
  EXPECT_EQ(farm.job(id).reason, "");
}

TEST(Sequences, AreForgottenWithAllTheirFrames) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-3"));
  farm.join(1);
  farm.work_all();
  const JobId frame = farm.job_of(id, 2);
  farm.send(input::Forget{{frame}});
  EXPECT_TRUE(farm.scheduler.job(frame, farm.now)) << "a frame is kept as long as its sequence";
  const std::vector<KeptJob> kept = farm.scheduler.kept();
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept.front().frame_jobs.size(), 3u);
  EXPECT_TRUE(kept.front().final);
  farm.send(input::Forget{{id}});
  EXPECT_THAT(farm.scheduler.jobs(farm.now), IsEmpty());
  EXPECT_FALSE(farm.scheduler.job(frame, farm.now));
  EXPECT_EQ(farm.all<action::DropJob>().size(), 3u);
  EXPECT_GT(farm.submit(test_job("next", StopAtSamples{1})), frame) << "ids are not used again";
}

TEST(Sequences, OlderSingleJobsAreRenderedBeforeASequenceAndNewerOnesAfterIt) {
  FrameFarm farm;
  const JobId before = farm.submit(test_job("before", StopAtSamples{8}));
  const JobId id = farm.submit_frames(test_sequence("1-12"));
  const JobId after = farm.submit(test_job("after", StopAtSamples{8}));
  farm.join(1);
  std::vector<JobId> order;
  while (farm.work()) {
  }
  for (const auto& lease : farm.all<action::Lease>()) {
    const JobId sequence = farm.job(lease.job).spec.sequence;
    const JobId job = sequence == 0 ? lease.job : sequence;
    if (order.empty() || order.back() != job) {
      order.push_back(job);
    }
  }
  EXPECT_THAT(order, ElementsAre(before, id, after));
}

/// Returns a scheduler that has replayed the records.
std::unique_ptr<Scheduler> restarted(const std::vector<Record>& records, Time now) {
  auto scheduler = std::make_unique<Scheduler>(test_options());
  for (const Record& record : records) {
    scheduler->replay(record);
  }
  scheduler->replayed(now);
  EXPECT_EQ(scheduler->broken_invariant().value_or(""), "");
  return scheduler;
}

TEST(Sequences, ARestartKeepsDoneAndFailedFrames) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-30"));
  farm.join(1);
  // Each job that renders frame 2 fails.
  farm.fails = {farm.job_of(id, 2)};
  while (farm.in_state(id, FrameState::kDone).size() < 10 && farm.work()) {
    farm.fails.insert(farm.job_of(id, 2));
  }
  const std::vector<FrameNumber> done = farm.in_state(id, FrameState::kDone);
  const std::vector<FrameNumber> failed = farm.in_state(id, FrameState::kFailed);
  EXPECT_THAT(failed, ElementsAre(2));
  for (const std::vector<Record>& records : {farm.records, farm.scheduler.snapshot()}) {
    const auto again = restarted(records, farm.now);
    std::vector<FrameNumber> done_again;
    const std::vector<FrameView> frames = *again->frames(id, 0);
    for (const FrameView& frame : frames) {
      if (frame.state == FrameState::kDone) {
        done_again.push_back(frame.number);
      }
      EXPECT_EQ(frame.state == FrameState::kFailed, frame.number == 2);
    }
    EXPECT_EQ(done_again, done);
    EXPECT_EQ(again->job(id, farm.now)->state, JobState::kRunning);
    EXPECT_EQ(again->snapshot().size(), farm.scheduler.snapshot().size());
    EXPECT_EQ(again->job(id, farm.now)->cpu_s, farm.job(id).cpu_s);
  }
}

TEST(Sequences, CancelledSequencesDoNotFail) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-10"));
  farm.join(1);
  while (farm.in_state(id, FrameState::kDone).size() < 2) {
    ASSERT_TRUE(farm.work());
  }
  const std::vector<FrameNumber> done = farm.in_state(id, FrameState::kDone);
  const JobId frame = farm.job_of(id, farm.in_state(id, FrameState::kRendering).front());
  const Step step = farm.send(input::Cancel{id});
  EXPECT_FALSE(farm.scheduler.job(frame, farm.now)) << "the job of an open frame is forgotten";
  EXPECT_FALSE(in<action::DropJob>(step).empty());
  const auto expect_right = [&](const Scheduler& scheduler) {
    const JobView view = *scheduler.job(id, farm.now);
    EXPECT_EQ(view.state, JobState::kCancelled);
    EXPECT_EQ(view.frames.of(FrameState::kDone), 2u);
    EXPECT_EQ(view.frames.of(FrameState::kWaiting), 8u);
    EXPECT_EQ(view.fraction, 0.2);
    EXPECT_THAT(scheduler.why(id, farm.now), ElementsAre("it was cancelled"));
    EXPECT_EQ(scheduler.jobs(farm.now).size(), 1u);
  };
  expect_right(farm.scheduler);
  EXPECT_EQ(farm.in_state(id, FrameState::kDone), done);
  for (const std::vector<Record>& records : {farm.records, farm.scheduler.snapshot()}) {
    expect_right(*restarted(records, farm.now));
  }
  farm.send(input::Forget{{id}});
  EXPECT_THAT(farm.scheduler.jobs(farm.now), IsEmpty());
}

TEST(Sequences, AnotherPixelVersionFailsTheWholeSequence) {
  FrameFarm farm;
  const JobId id = farm.submit_frames(test_sequence("1-3"));
  SchedulerOptions options = test_options();
  options.compatibility.pixel_version += 1;
  Scheduler other(options);
  for (const Record& record : farm.records) {
    other.replay(record);
  }
  other.replayed(farm.now);
  EXPECT_EQ(other.job(id, farm.now)->state, JobState::kFailed);
  EXPECT_THAT(other.job(id, farm.now)->reason, HasSubstr("pixel version"));
  EXPECT_THAT(other.frames(id, 0)->front().reason, HasSubstr("pixel version"));
  EXPECT_EQ(other.step(input::RetryFrames{id, {}}, farm.now).status.code(),
            absl::StatusCode::kFailedPrecondition);
}

// A sequence has at most 50,000 frames, and all jobs and frames of a farm are at most 100,000.
TEST(Sequences, TooManyFramesAreRefused) {
  FrameFarm farm;
  SequenceSpec spec = test_sequence("1-50000");
  EXPECT_TRUE(farm.scheduler.step(input::SubmitSequence{spec}, farm.now).status.ok());
  spec.request_id = "2";
  EXPECT_TRUE(farm.scheduler.step(input::SubmitSequence{spec}, farm.now).status.ok());
  spec.request_id = "3";
  EXPECT_EQ(farm.scheduler.step(input::SubmitSequence{spec}, farm.now).status.code(),
            absl::StatusCode::kResourceExhausted);
  spec.request_id = "4";
  spec.frames.clear();
  EXPECT_EQ(farm.scheduler.step(input::SubmitSequence{spec}, farm.now).status.code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace bandsaw::coordinator
