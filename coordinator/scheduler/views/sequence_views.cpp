// Makes the view of a sequence (a job of many frames) from the states of its frames and from the
// progress of the frame jobs that are not final. Each frame is rendered by its own frame job.

#include "coordinator/scheduler/views/sequence_views.h"

#include <algorithm>
#include <set>

#include "absl/strings/str_cat.h"
#include "coordinator/scheduler/api/frame_numbers.h"
#include "coordinator/scheduler/views/progress.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::size_t kMaxNumbers = 200;  ///< maximum bytes of the frame numbers in a sentence

/// Returns a sum over the frames being rendered. Each frame adds the part of it that is done, in
/// [0, 1].
double rendered_parts(const Context& context, const Sequence& sequence, Time now) {
  double parts = 0;
  for (const JobId id : sequence.open_jobs()) {
    parts += fraction_done(context.jobs.at(id), now);
  }
  return parts;
}

/// Returns the remaining time in seconds at the pace since Sequence::restart_clock(). Negative:
/// unknown. The time is always unknown while a user has paused the sequence, and while no frame
/// that is left has a scene. `parts`: the result of rendered_parts().
double remaining_of(const Sequence& sequence, double parts, Time now) {
  const FrameCounts& counts = sequence.counts();
  const auto left = static_cast<double>(counts.all() - counts.of(FrameState::kDone) -
                                        counts.of(FrameState::kFailed)) -
                    parts;
  const double finished =
      static_cast<double>(counts.of(FrameState::kDone) - sequence.done_before) + parts;
  if (is_final(sequence.state)) {
    return 0;
  }
  if (sequence.held || counts.of(FrameState::kRendering) + counts.of(FrameState::kWaiting) == 0) {
    return -1;
  }
  const double passed = sequence.elapsed(now) - sequence.elapsed_then;
  // While less than half a frame is rendered, the pace is not known well enough.
  return finished > 0.5 && passed > 0 ? left * passed / finished : -1;
}

/// Returns the first open frame job if all open frame jobs are paused, for example because the disk
/// is full, although no user has paused the sequence. Otherwise, and if no frame job is open,
/// returns nullptr.
const Job* first_of_paused(const Context& context, const Sequence& sequence) {
  const Job* first = nullptr;
  for (const JobId id : sequence.open_jobs()) {
    const Job& job = context.jobs.at(id);
    if (sequence.held || job.state != JobState::kPaused) {
      return nullptr;
    }
    first = first == nullptr ? &job : first;
  }
  return first;
}

/// Adds each worker that renders a frame to the view, once. The state of a worker names the first
/// of the frames that it renders. Adds the workers' speeds to the view's speed. Sorts the workers
/// by name.
void add_workers(const Context& context, const Sequence& sequence, JobView& view) {
  std::set<std::string> named;
  for (const JobId id : sequence.open_jobs()) {
    const Job& job = context.jobs.at(id);
    for (JobWorkerView& worker : workers_on(context, job)) {
      if (named.insert(worker.name).second) {
        worker.state =
            absl::StrCat("frame ", job.spec.frame, worker.state == "rendering" ? "" : ": ",
                         worker.state == "rendering" ? "" : worker.state);
        view.samples_per_s += worker.samples_per_s;
        view.workers.push_back(std::move(worker));
      }
    }
  }
  std::sort(view.workers.begin(), view.workers.end(),
            [](const JobWorkerView& a, const JobWorkerView& b) { return a.name < b.name; });
}

/// Cuts a list of frame numbers after at most kMaxNumbers bytes, at a comma.
std::string shortened(std::string numbers) {
  return numbers.size() <= kMaxNumbers
             ? numbers
             : absl::StrCat(numbers.substr(0, numbers.rfind(',', kMaxNumbers)), ",…");
}

}  // namespace

JobView sequence_view(const Context& context, const Sequence& sequence, Time now) {
  now = std::max(now, context.clock.wall());
  JobView view;
  view.id = sequence.id;
  view.spec.request_id = sequence.spec.request_id;
  view.spec.name = sequence.spec.name;
  view.spec.settings = sequence.spec.settings;
  view.spec.stop = sequence.spec.stop;
  view.spec.manifest = sequence.frames().front().manifest;
  view.state = sequence.state;
  view.reason = sequence.reason;
  view.priority = sequence.priority;
  view.frames = sequence.counts();
  const FrameCounts& counts = sequence.counts();
  const double parts = rendered_parts(context, sequence, now);
  const auto over =
      static_cast<double>(counts.of(FrameState::kDone) + counts.of(FrameState::kFailed));
  view.fraction = (over + parts) / static_cast<double>(counts.all());
  view.elapsed_s = sequence.elapsed(now);
  view.remaining_s = remaining_of(sequence, parts, now);
  if (const Job* paused = first_of_paused(context, sequence)) {
    view.state = JobState::kPaused;
    view.reason = paused->reason;
    view.remaining_s = -1;
  }
  Totals totals = sequence.done;
  view.workers_used = sequence.workers_used;
  for (const JobId id : sequence.open_jobs()) {
    const Job& job = context.jobs.at(id);
    totals.add(job.totals());
    view.workers_used = std::max(view.workers_used, static_cast<std::uint32_t>(job.shares.size()));
  }
  view.samples_done = totals.samples;
  view.counters = totals.counters;
  view.cpu_s = totals.cpu_s;
  view.error = sequence.worst_error;
  add_workers(context, sequence, view);
  return view;
}

std::vector<FrameView> frame_views(const Sequence& sequence, std::uint64_t after) {
  std::vector<FrameView> views;
  for (const Sequence::Frame& frame : sequence.frames()) {
    if (after == 0 || frame.changed > after) {
      views.push_back({frame.number, frame.state, frame.job, frame.reason, frame.changed});
    }
  }
  return views;
}

std::vector<std::string> frame_sentences(const Sequence& sequence) {
  std::vector<std::string> lines;
  const auto add = [&](FrameState state, const char* what) {
    if (const std::vector<FrameNumber> numbers = sequence.numbers(state); !numbers.empty()) {
      lines.push_back(absl::StrCat(numbers.size() == 1 ? "frame " : "frames ",
                                   shortened(frames_text(numbers)), " ", what));
    }
  };
  add(FrameState::kRendering, "being rendered, or about to be");
  add(FrameState::kWaiting, "waiting to be rendered");
  add(FrameState::kExpected,
      "expected: their scenes have not arrived; if their submitter has ended, submit them again "
      "with --continue");
  constexpr std::size_t kMaxReasons = 10;
  const std::vector<FrameNumber> failed = sequence.numbers(FrameState::kFailed);
  for (std::size_t i = 0; i < std::min(failed.size(), kMaxReasons); ++i) {
    lines.push_back(
        absl::StrCat("frame ", failed[i], " failed: ", sequence.frame(failed[i])->reason));
  }
  if (failed.size() > kMaxReasons) {
    lines.emplace_back("and more frames failed");
  }
  return lines;
}

}  // namespace bandsaw::coordinator
