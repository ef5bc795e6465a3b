// A clean picture is the denoised image of a job. Its guides are images of albedo and shape, from
// which the denoiser learns where edges are. For each clean picture, submits the jobs that render
// the guides, waits until these jobs are done, and runs the filter (the denoiser).

#include "coordinator/web/clean_pictures.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/blocking_call.h"
#include "coordinator/rpc/picture.h"
#include "coordinator/scheduler/api/clean_jobs.h"
#include "proto/link/random.h"
#include "renderlib/base/pool.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/denoise/halves.h"
#include "renderlib/image/shrink.h"
#include "renderlib/render/first_part.h"
#include "renderlib/render/kernel.h"

namespace bandsaw::coordinator {
namespace {

/// Number of pictures that are kept. Others are filtered again when they are requested.
constexpr std::size_t kMaxKept = 4;
/// Bytes that the filter needs for each pixel (renderlib/denoise/README.md).
constexpr std::uint64_t kFilterBytes = 400;

/// Returns OK if the image of this job can be cleaned here now, else FAILED_PRECONDITION.
absl::Status check(const JobView& job) {
  if (job.state != JobState::kDone) {
    return absl::FailedPreconditionError(
        absl::StrCat("job ", job.id, " is not done; only finished images are cleaned"));
  }
  RETURN_IF_ERROR(check_cleanable(job.spec.settings, job.samples_per_pixel));
  const std::uint64_t pixels = std::uint64_t{job.spec.settings.width} * job.spec.settings.height;
  return pixels <= CleanPictures::kMaxPixels
             ? absl::OkStatus()
             : absl::FailedPreconditionError(absl::StrCat(
                   "the image is too large to be cleaned here; clean it on your own machine with "
                   "`bandsaw watch ",
                   job.id, " --denoise -o FILE`"));
}

}  // namespace

absl::StatusOr<JobId> CleanPictures::submit_job(JobSpec spec, std::int32_t priority) {
  using Answer = absl::StatusOr<JobId>;
  const auto submit = [&] {
    return blocking_call<Answer>([&](auto answer) { engine_.submit(spec, answer, priority); });
  };
  ASSIGN_OR_RETURN(const JobId job, submit());
  ASSIGN_OR_RETURN(const JobView view, job_view(engine_, job));
  if (!is_final(view.state) || view.state == JobState::kDone) {
    return job;
  }
  spec.request_id = link::random_hex(16);  // the earlier job failed or was cancelled
  return submit();
}

absl::StatusOr<std::vector<JobId>> CleanPictures::submit_jobs(const JobView& of) {
  CleanJobs wanted = clean_jobs(of.spec, of.samples_per_pixel);
  std::vector<JobId> jobs;
  for (JobSpec* spec :
       {&wanted.albedo, &wanted.shape, wanted.further ? &*wanted.further : nullptr}) {
    if (spec != nullptr) {
      ASSIGN_OR_RETURN(const JobId job, submit_job(std::move(*spec), of.priority));
      jobs.push_back(job);
    }
  }
  return jobs;
}

absl::StatusOr<CleanPictures::State> CleanPictures::start(JobId id) {
  ASSIGN_OR_RETURN(const JobView job, job_view(engine_, id));
  RETURN_IF_ERROR(check(job));
  {
    MutexLock lock(mutex_);
    const Stage stage = entries_[id].stage;
    if (stage == Stage::kNone || stage == Stage::kFailed) {
      entries_.erase(id);
    }
    if (entries_.contains(id)) {
      return State{.stage = stage};
    }
  }
  // Requests at the same time get the same jobs, because their request ids are equal.
  ASSIGN_OR_RETURN(std::vector<JobId> jobs, submit_jobs(job));
  MutexLock lock(mutex_);
  Entry& entry = entries_[id];
  if (entry.stage == Stage::kNone) {
    entry = {.stage = Stage::kGuides, .jobs = std::move(jobs), .used = ++calls_};
  }
  return State{.stage = entry.stage};
}

absl::StatusOr<CleanPictures::State> CleanPictures::state(JobId id) {
  ASSIGN_OR_RETURN(const JobView job, job_view(engine_, id));
  std::vector<JobId> jobs;
  {
    MutexLock lock(mutex_);
    const auto found = entries_.find(id);
    if (found == entries_.end()) {
      return State{};
    }
    Entry& entry = found->second;
    entry.used = ++calls_;
    if (entry.stage != Stage::kGuides) {
      return State{.stage = entry.stage,
                   .why = entry.why,
                   .error = entry.kept != nullptr ? entry.kept->clean.total : CleanError()};
    }
    jobs = entry.jobs;
  }
  double done = 0;
  absl::Status why;
  for (const JobId guide : jobs) {
    const absl::StatusOr<JobView> view = job_view(engine_, guide);
    if (!view.ok()) {
      why.Update(view.status());
    } else if (is_final(view->state) && view->state != JobState::kDone) {
      why.Update(absl::AbortedError(
          absl::StrCat("job ", guide, ", which the clean image needs, ", state_name(view->state))));
    } else {
      // A job that is not done counts less than 1. So `done` reaches the number of jobs only when
      // all of them are done.
      done += view->state == JobState::kDone ? 1 : std::min(view->fraction, 0.99);
    }
  }
  MutexLock lock(mutex_);
  Entry& entry = entries_[id];
  if (entry.stage != Stage::kGuides) {  // another call was faster
    return State{.stage = entry.stage, .why = entry.why};
  }
  if (!why.ok()) {
    entry = {.stage = Stage::kFailed, .why = why, .used = calls_};
  } else if (done >= static_cast<double>(jobs.size())) {
    entry.stage = Stage::kFiltering;
    executor_.post([this, job, jobs] { filter(job, jobs); });
  }
  return State{
      .stage = entry.stage, .fraction = done / static_cast<double>(jobs.size()), .why = entry.why};
}

void CleanPictures::filter(const JobView& job, const std::vector<JobId>& jobs) {
  absl::StatusOr<Kept> made = filtered(job, jobs);
  MutexLock lock(mutex_);
  Entry& entry = entries_[job.id];
  entry.stage = made.ok() ? Stage::kReady : Stage::kFailed;
  entry.why = made.status();
  if (made.ok()) {
    entry.kept = std::make_shared<const Kept>(*std::move(made));
  }
  entry.used = ++calls_;
  forget_oldest();
}

absl::StatusOr<CleanPictures::Kept> CleanPictures::filtered(const JobView& job,
                                                            const std::vector<JobId>& jobs) {
  ASSIGN_OR_RETURN(HeldImage image, result_of(engine_, job.id));
  ASSIGN_OR_RETURN(HeldImage albedo, result_of(engine_, jobs[0]));
  ASSIGN_OR_RETURN(HeldImage shape, result_of(engine_, jobs[1]));
  // For a picture without parts, a third job has rendered further samples.
  const bool has_parts = jobs.size() == 2;
  ASSIGN_OR_RETURN(HeldImage part, has_parts ? result_of(engine_, job.id, FinishedPart::kFirst)
                                             : result_of(engine_, jobs[2]));
  std::optional<HeldImage> counts;
  if (is_adaptive(job.spec.stop)) {
    ASSIGN_OR_RETURN(counts, result_of(engine_, job.id, FinishedPart::kSamples));
  }
  const std::size_t pixels = image.result.image.pixels.size();
  auto share = engine_.images().take(pixels * kFilterBytes);
  if (!share) {
    return absl::ResourceExhaustedError(
        "images that are viewed or downloaded leave no memory to clean this one; try again later");
  }
  DenoiseInput input;
  input.albedo = std::move(albedo.result.image);
  input.shape = std::move(shape.result.image);
  if (has_parts) {
    input.mean = std::move(image.result.image);
    input.first = std::move(part.result.image);
    input.first_share = counts ? first_part_shares(counts->result.image)
                               : first_part_shares(job.samples_per_pixel, pixels);
  } else {
    add_samples(image.result.image, static_cast<double>(job.samples_per_pixel),
                std::move(part.result.image),
                static_cast<double>(further_samples(job.samples_per_pixel)), input);
  }
  Pool pool(1);
  Kept kept{denoise(input, kernels().front()->fit, pool), image.result.display, *std::move(share)};
  kept.share.resize(2 * pixels * sizeof(Rgb));  // for the clean image and its error
  return kept;
}

void CleanPictures::forget_oldest() {
  const auto is_kept = [](const auto& one) { return one.second.kept != nullptr; };
  while (std::count_if(entries_.begin(), entries_.end(), is_kept) >
         static_cast<std::ptrdiff_t>(kMaxKept)) {
    auto oldest = entries_.end();
    for (auto at = entries_.begin(); at != entries_.end(); ++at) {
      if (is_kept(*at) && (oldest == entries_.end() || at->second.used < oldest->second.used)) {
        oldest = at;
      }
    }
    entries_.erase(oldest);
  }
}

absl::StatusOr<CleanPictures::Bytes> CleanPictures::file(JobId id, std::uint32_t most_side,
                                                         ImageFormat format) {
  std::shared_ptr<const Kept> kept;
  {
    MutexLock lock(mutex_);
    if (const auto found = entries_.find(id); found != entries_.end()) {
      found->second.used = ++calls_;
      kept = found->second.kept;
    }
  }
  if (kept == nullptr) {
    return absl::FailedPreconditionError(
        absl::StrCat("there is no clean picture of job ", id, "; ask for it first"));
  }
  MutexLock lock(encoding_);
  const Image& image = kept->clean.image;
  std::vector<std::byte> bytes;
  if (format == ImageFormat::kExr) {
    ASSIGN_OR_RETURN(HeldImage raw, result_of(engine_, id));
    const Layers layers = {{.name = "raw", .image = std::move(raw.result.image)},
                           {.name = "error", .image = kept->clean.error, .is_number = true}};
    ASSIGN_OR_RETURN(bytes, encode_image(image, format, kept->display, layers));
  } else {
    const std::uint32_t side = std::max(image.width, image.height);
    const std::uint32_t step = most_side > 0 ? (side - 1) / most_side + 1 : 1;
    ASSIGN_OR_RETURN(bytes, step > 1
                                ? encode_image(shrunk(image, step, step), format, kept->display)
                                : encode_image(image, format, kept->display));
  }
  return std::make_shared<const std::string>(reinterpret_cast<const char*>(bytes.data()),
                                             bytes.size());
}

}  // namespace bandsaw::coordinator
