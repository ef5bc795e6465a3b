// advance() brings each sequence up to date in every step: it tries failed frames again, makes the
// next frame jobs, and ends the sequence when all frames are done or have failed. The other
// functions are requests of users.

#include "coordinator/scheduler/jobs/sequences.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "coordinator/scheduler/api/frame_numbers.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {
namespace {

/// Number of frame jobs of a sequence that are made ahead of need: kAheadInAll, and kAheadPerWorker
/// more for each worker. So each worker can have bands of two frames while the images of other
/// frames are being written.
constexpr std::size_t kAheadPerWorker = 2;
constexpr std::size_t kAheadInAll = 4;
/// Maximum number of frame jobs that are not final, counted over all sequences that are not paused.
/// The first kAheadInAll frame jobs of each sequence are made even beyond this limit, so that no
/// sequence waits for others.
constexpr std::size_t kMaxOpenFrames = wire::kActiveJobs / 2;
/// Maximum number of bytes of a list of frame numbers in a message.
constexpr std::size_t kMaxNumbers = 200;

/// Returns the sentence that tells users which frames of the sequence failed, and why the first of
/// them did.
std::string failed_text(const Sequence& sequence) {
  const std::vector<FrameNumber> failed = sequence.numbers(FrameState::kFailed);
  std::string numbers = frames_text(failed);
  if (numbers.size() > kMaxNumbers) {
    numbers = absl::StrCat(numbers.substr(0, numbers.rfind(',', kMaxNumbers)), ",…");
  }
  return absl::StrCat(failed.size() == 1 ? "frame " : "frames ", numbers,
                      " failed: ", sequence.frame(failed.front())->reason,
                      "; render them again with: bandsaw retry ", sequence.id);
}

absl::Status no_such_frame(const Sequence& sequence, FrameNumber number) {
  return absl::InvalidArgumentError(
      absl::StrCat("job ", sequence.id, " has no frame ", number, "; its frames are ",
                   frames_text(sequence.spec.frames).substr(0, kMaxNumbers)));
}

}  // namespace

void Sequences::submit(const input::SubmitSequence& in) {
  if (const auto known = context_.sequences.by_request(in.spec.request_id)) {
    context_.answer_job(*known);
    if (context_.sequences.at(*known).spec != in.spec) {
      context_.answer(absl::AlreadyExistsError(
          absl::StrCat("request id ", in.spec.request_id, " is job ", *known,
                       " with other frames or other settings; submit with a new request id")));
    }
    return;
  }
  absl::Status status =
      in.spec.frames.empty() || in.spec.frames.size() > kMaxFrames
          ? absl::InvalidArgumentError(absl::StrCat("a sequence must have 1 to ", kMaxFrames,
                                                    " frames, has ", in.spec.frames.size()))
          : requests_.refusal(in.spec.stop, in.spec.settings, in.priority, in.spec.frames.size());
  if (!status.ok()) {
    context_.answer(std::move(status));
    return;
  }
  const JobId id = context_.jobs.next_id();
  context_.answer_job(id);
  context_.emit(record::SequenceAdded{id, in.spec, context_.options.compatibility.pixel_version});
  if (in.priority != 0) {
    context_.emit(record::PriorityChanged{id, in.priority});
  }
}

/// Returns the sequence with this id. If there is none or it was cancelled, returns nullptr and
/// sets the status of the step to an error.
Sequence* Sequences::find_active(JobId id) {
  Sequence* sequence = context_.sequences.find(id);
  if (sequence == nullptr) {
    context_.answer(context_.jobs.find(id) == nullptr
                        ? absl::NotFoundError(absl::StrCat("there is no job ", id))
                        : absl::FailedPreconditionError(
                              absl::StrCat("job ", id, " has no frames: it is a single image")));
  } else if (sequence->state == JobState::kCancelled) {
    context_.answer(absl::FailedPreconditionError(
        absl::StrCat("job ", id, " was cancelled; submit its frames again")));
    sequence = nullptr;
  }
  return sequence;
}

void Sequences::add_frames(const input::AddFrames& in) {
  const Sequence* sequence = find_active(in.job);
  if (sequence == nullptr) {
    return;
  }
  for (const FrameScene& scene : in.scenes) {
    if (sequence->frame(scene.number) == nullptr) {
      context_.answer(no_such_frame(*sequence, scene.number));
      return;
    }
  }
  for (const FrameScene& scene : in.scenes) {
    if (sequence->frame(scene.number)->state == FrameState::kExpected) {
      context_.emit(record::FrameWaits{in.job, scene.number, scene.manifest, scene.package_bytes,
                                       /*failures=*/0, /*reason=*/""});
    }
  }
}

void Sequences::retry(const input::RetryFrames& in) {
  Sequence* sequence = find_active(in.job);
  if (sequence == nullptr) {
    return;
  }
  std::vector<FrameNumber> numbers =
      in.frames.empty() ? sequence->numbers(FrameState::kFailed) : in.frames;
  for (const FrameNumber number : numbers) {
    const Sequence::Frame* frame = sequence->frame(number);
    if (frame == nullptr) {
      context_.answer(no_such_frame(*sequence, number));
      return;
    }
    if (frame->state != FrameState::kFailed) {
      context_.answer(absl::FailedPreconditionError(absl::StrCat("frame ", number, " of job ",
                                                                 in.job, " has not failed: it is ",
                                                                 frame_state_name(frame->state))));
      return;
    }
  }
  if (numbers.empty()) {
    context_.answer(
        absl::FailedPreconditionError(absl::StrCat("no frame of job ", in.job, " has failed")));
    return;
  }
  if (const std::uint32_t here = context_.options.compatibility.pixel_version;
      sequence->pixel_version != here) {
    context_.answer(absl::FailedPreconditionError(
        absl::StrCat("job ", in.job, " was ", other_pixel_version(sequence->pixel_version, here))));
    return;
  }
  if (is_final(sequence->state)) {
    context_.emit(record::StateChanged{in.job, JobState::kRunning, ""});
  }
  for (const FrameNumber number : numbers) {
    wait_again(*sequence, number, /*failures=*/0, /*reason=*/"");
  }
}

/// Makes the frame wait again, and forgets the frame's job, which has failed or was cancelled.
/// `failures`: number of the frame's jobs that count as failed.
void Sequences::wait_again(Sequence& sequence, FrameNumber number, std::uint32_t failures,
                           const std::string& reason) {
  const Sequence::Frame& frame = *sequence.frame(number);
  const JobId old = frame.job;
  context_.emit(record::FrameWaits{sequence.id, number, DigestHex(frame.manifest),
                                   frame.package_bytes, failures, std::string(reason)});
  forget_job(old);
}

void Sequences::forget_job(JobId id) {
  if (context_.jobs.find(id) != nullptr) {
    context_.emit(record::JobForgotten{id});
    context_.act(action::DropJob{id});
  }
}

void Sequences::cancel(const input::Cancel& in) {
  Sequence& sequence = context_.sequences.at(in.job);
  if (!is_final(sequence.state)) {
    end(sequence, JobState::kCancelled, "");
  }
}

/// Ends the sequence, and cancels its frame jobs that are not final. If the sequence itself is
/// cancelled, these frame jobs are also forgotten, so that their frames count as waiting and not as
/// failed.
void Sequences::end(Sequence& sequence, JobState state, const std::string& reason) {
  context_.emit(record::TimeSpent{sequence.id, sequence.elapsed(context_.clock.wall())});
  context_.emit(record::StateChanged{sequence.id, state, clean_text(reason, wire::kReasonBytes)});
  const std::set<JobId> open = sequence.open_jobs();
  for (const JobId id : open) {
    Job& job = context_.jobs.at(id);
    const FrameNumber frame = job.spec.frame;
    lifecycle_.end(job, JobState::kCancelled, reason);
    if (state == JobState::kCancelled) {
      wait_again(sequence, frame, /*failures=*/0, /*reason=*/"");
    }
  }
}

void Sequences::pause(const input::Pause& in) {
  const Sequence& sequence = context_.sequences.at(in.job);
  if (is_final(sequence.state)) {
    context_.answer(absl::FailedPreconditionError(absl::StrCat("job ", in.job, " is over")));
    return;
  }
  if (sequence.held) {
    return;
  }
  context_.emit(record::HoldChanged{in.job, true});
  context_.emit(record::StateChanged{in.job, JobState::kPaused, kPausedByUser});
  for (const JobId id : sequence.open_jobs()) {
    if (Job& job = context_.jobs.at(id); !job.held && job.state != JobState::kFinishing) {
      requests_.hold(job);
    }
  }
}

void Sequences::resume(const input::Resume& in) {
  const Sequence& sequence = context_.sequences.at(in.job);
  if (is_final(sequence.state)) {
    context_.answer(absl::FailedPreconditionError(absl::StrCat("job ", in.job, " is over")));
    return;
  }
  if (sequence.held) {
    context_.emit(record::HoldChanged{in.job, false});
    context_.emit(record::StateChanged{in.job, JobState::kRunning, ""});
  }
  for (const JobId id : sequence.open_jobs()) {
    requests_.release(context_.jobs.at(id));
  }
}

void Sequences::set_priority(const input::SetPriority& in) {
  const Sequence& sequence = context_.sequences.at(in.job);
  if (is_final(sequence.state)) {
    context_.answer(absl::FailedPreconditionError(absl::StrCat("job ", in.job, " is over")));
    return;
  }
  if (absl::Status status = JobRequests::check_priority(in.priority); !status.ok()) {
    context_.answer(std::move(status));
    return;
  }
  if (sequence.priority == in.priority) {
    return;
  }
  context_.emit(record::PriorityChanged{in.job, in.priority});
  for (const JobId id : sequence.open_jobs()) {
    context_.emit(record::PriorityChanged{id, in.priority});
  }
}

void Sequences::forget(const input::Forget& in) {
  for (const JobId id : in.jobs) {
    const Sequence* sequence = context_.sequences.find(id);
    if (sequence == nullptr || !is_final(sequence->state)) {
      continue;
    }
    for (const Sequence::Frame& frame : sequence->frames()) {
      forget_job(frame.job);
    }
    context_.emit(record::JobForgotten{id});
  }
}

void Sequences::advance() {
  std::set<std::pair<std::int32_t, JobId>> order;  // by descending priority, then by id
  std::size_t open_frames = 0;
  for (const JobId id : context_.sequences.active()) {
    const Sequence& sequence = context_.sequences.at(id);
    order.insert({-sequence.priority, id});
    open_frames += sequence.held ? 0 : sequence.open_jobs().size();
  }
  for (const auto& [descending_priority, id] : order) {
    advance(context_.sequences.at(id), open_frames);
  }
}

/// Brings one sequence up to date. `open_frames`: number of frame jobs that count against
/// kMaxOpenFrames. It is increased by the number of frame jobs that this function makes.
void Sequences::advance(Sequence& sequence, std::size_t& open_frames) {
  while (const Sequence::Frame* failed = sequence.next_to_retry()) {
    wait_again(sequence, failed->number, failed->failures + 1, failed->reason);
  }
  if (sequence.held) {
    return;
  }
  const std::size_t ahead = kAheadInAll + kAheadPerWorker * context_.available.eligible();
  const auto may_add = [&](std::size_t own) {
    const bool room =
        open_frames < kMaxOpenFrames && context_.jobs.active().size() < wire::kActiveJobs;
    return own < kAheadInAll || (own < ahead && room);
  };
  while (may_add(sequence.open_jobs().size())) {
    const Sequence::Frame* next = sequence.next_waiting();
    if (next == nullptr) {
      break;
    }
    requests_.add(sequence.job_spec(*next), sequence.priority);
    ++open_frames;
  }
  const FrameCounts& counts = sequence.counts();
  const std::size_t over = counts.of(FrameState::kDone) + counts.of(FrameState::kFailed);
  if (over == counts.all()) {
    const bool failed = counts.of(FrameState::kFailed) > 0;
    end(sequence, failed ? JobState::kFailed : JobState::kDone,
        failed ? failed_text(sequence) : "");
  }
}

void Sequences::note_times() {
  for (const JobId id : context_.sequences.active()) {
    const Sequence& sequence = context_.sequences.at(id);
    const double spent = sequence.elapsed(context_.clock.wall());
    if (sequence.clock.runs() &&
        spent - sequence.elapsed_noted >= std::max(1.0, sequence.elapsed_noted / 50)) {
      context_.emit(record::TimeSpent{id, spent});
    }
  }
}

void Sequences::resume_after_restart() {
  const std::uint32_t here = context_.options.compatibility.pixel_version;
  for (auto& [id, sequence] : context_.sequences.all()) {
    sequence.restart_clock();
    if (!is_final(sequence.state) && sequence.pixel_version != here) {
      end(sequence, JobState::kFailed, other_pixel_version(sequence.pixel_version, here));
    }
  }
}

std::string other_pixel_version(std::uint32_t begun_with, std::uint32_t here) {
  const std::string version =
      begun_with == 0 ? "an earlier pixel version" : absl::StrCat("pixel version ", begun_with);
  return absl::StrCat("begun with ", version, ", this coordinator has ", here,
                      ": an image is of one version; submit it again");
}

}  // namespace bandsaw::coordinator
