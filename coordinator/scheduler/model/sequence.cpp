// A sequence is a job of many frames. change() is the only place that changes the state of a frame;
// it keeps the counts and sets of frames consistent.

#include "coordinator/scheduler/model/sequence.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/render/frame_seed.h"

namespace bandsaw::coordinator {

Sequence::Sequence(JobId sequence, SequenceSpec sequence_spec, std::uint32_t version)
    : id(sequence), spec(std::move(sequence_spec)), pixel_version(version) {
  for (const FrameNumber number : spec.frames) {
    frames_.push_back({.number = number, .manifest = {}, .reason = {}});
  }
  counts_.in[static_cast<std::size_t>(FrameState::kExpected)] = frames_.size();
}

Sequence::Frame* Sequence::find(FrameNumber number) {
  return const_cast<Frame*>(std::as_const(*this).frame(number));
}

const Sequence::Frame* Sequence::frame(FrameNumber number) const {
  const auto found =
      std::lower_bound(frames_.begin(), frames_.end(), number,
                       [](const Frame& frame, FrameNumber n) { return frame.number < n; });
  return found == frames_.end() || found->number != number ? nullptr : &*found;
}

std::vector<FrameNumber> Sequence::numbers(FrameState wanted) const {
  std::vector<FrameNumber> out;
  for (const Frame& frame : frames_) {
    if (frame.state == wanted) {
      out.push_back(frame.number);
    }
  }
  return out;
}

const Sequence::Frame* Sequence::next_waiting() const {
  return waiting_.empty() ? nullptr : frame(*waiting_.begin());
}

const Sequence::Frame* Sequence::next_to_retry() const {
  return to_retry_.empty() ? nullptr : frame(*to_retry_.begin());
}

JobSpec Sequence::job_spec(const Frame& frame) const {
  JobSpec job;
  // Which bands are audited (rendered a second time, to compare) follows from the request id, and
  // workers must not be able to predict which. Workers cannot guess this request id, because they
  // do not know the request id of the sequence. Submitters cannot choose such an id, because they
  // may not use '/'.
  job.request_id = absl::StrCat("sequence/", id, "/", spec.request_id, "/", frame.number);
  job.name = absl::StrCat(spec.name, " frame ", frame.number);
  job.manifest = frame.manifest;
  job.settings = spec.settings;
  if (!spec.fixed_seed) {
    job.settings.seed = seed_of_frame(spec.settings.seed, frame.number);
  }
  job.stop = spec.stop;
  job.sequence = id;
  job.frame = frame.number;
  job.package_bytes = frame.package_bytes;
  return job;
}

double Sequence::elapsed(Time now) const {
  return is_final(state) ? elapsed_noted : clock.elapsed(now);
}

void Sequence::restart_clock() {
  clock.set(elapsed_noted);
  elapsed_then = elapsed_noted;
  done_before = counts_.of(FrameState::kDone);
}

void Sequence::change(Frame& frame, FrameState to) {
  --counts_.in[static_cast<std::size_t>(frame.state)];
  ++counts_.in[static_cast<std::size_t>(to)];
  waiting_.erase(frame.number);
  to_retry_.erase(frame.number);
  if (to == FrameState::kWaiting) {
    waiting_.insert(frame.number);
  }
  frame.state = to;
  frame.changed = ++changes_;
}

void Sequence::wait(const FrameScene& scene, std::uint32_t failures, const std::string& why) {
  if (Frame* frame = find(scene.number)) {
    open_jobs_.erase(frame->job);
    frame->manifest = scene.manifest;
    frame->package_bytes = scene.package_bytes;
    frame->job = 0;
    frame->failures = failures;
    frame->reason = why;
    change(*frame, FrameState::kWaiting);
  }
}

void Sequence::start(FrameNumber number, JobId job) {
  if (Frame* frame = find(number)) {
    frame->job = job;
    open_jobs_.insert(job);
    change(*frame, FrameState::kRendering);
  }
}

void Sequence::end(const Job& job) {
  Frame* frame = find(job.spec.frame);
  open_jobs_.erase(job.id);
  if (frame == nullptr || frame->job != job.id) {
    return;
  }
  if (job.state != JobState::kDone) {
    const bool cancelled = job.state == JobState::kCancelled;
    frame->reason =
        cancelled && job.reason.empty() ? "a user cancelled this frame's job" : job.reason;
    change(*frame, FrameState::kFailed);
    if (!cancelled && frame->failures + 1 < kTries) {
      to_retry_.insert(frame->number);
    }
    return;
  }
  frame->reason.clear();
  done.add(job.totals());
  if (job.summary) {
    worst_error = std::max(worst_error, job.summary->error);
    workers_used = std::max(workers_used, job.summary->workers_used);
  }
  change(*frame, FrameState::kDone);
}

}  // namespace bandsaw::coordinator
