// When the farm has finished a job, this machine removes the noise of the job's image. The farm
// renders the denoiser's guides (images of the albedo and the shape of the surfaces), as jobs of
// their own.

#include "coordinator/cli/farm/clean_job.h"

#include <algorithm>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/farm/call_with_retries.h"
#include "coordinator/cli/farm/watch_job.h"
#include "coordinator/cli/image/clean.h"
#include "coordinator/scheduler/api/clean_jobs.h"
#include "proto/convert/render_values.h"
#include "proto/link/random.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/first_part.h"

namespace bandsaw::coordinator {
namespace {

/// Returns the request to the farm that submits the job `spec`. `manifest`: digest of the manifest
/// of the job's scene.
farm::SubmitRequest request_of(const JobSpec& spec, const std::string& manifest,
                               std::int32_t priority) {
  farm::SubmitRequest request;
  request.set_request_id(spec.request_id);
  request.set_name(spec.name);
  request.set_manifest_sha256(manifest);
  *request.mutable_settings() = bandsaw::to_message(spec.settings);
  *request.mutable_stop() = to_message(spec.stop);
  request.set_priority(priority);
  return request;
}

/// Submits a job that the clean image needs. The farm recognises a job that it already has by the
/// request id, and returns the id of that job. FAILED_PRECONDITION: the scene is gone.
absl::StatusOr<JobId> submit(FarmClient& client, const JobSpec& spec, std::int32_t priority) {
  ASSIGN_OR_RETURN(const wire::Digest manifest, wire::digest_from_hex(spec.manifest));
  const farm::SubmitRequest request = request_of(spec, manifest.raw(), priority);
  absl::StatusOr<JobId> job = call_with_retries(client, [&] { return client.submit(request); });
  return absl::IsFailedPrecondition(job.status())
             ? absl::FailedPreconditionError(
                   absl::StrCat("the farm cannot render the guides of the clean image (",
                                job.status().message(), "); submit the scene again with --denoise"))
             : std::move(job);
}

/// Renders images on a farm: submits all jobs, then fetches one image after the other.
class FarmRenderer {
 public:
  FarmRenderer(FarmClient& client, std::int32_t priority, ProgressDisplay& display)
      : client_(client), priority_(priority), display_(display) {}

  absl::StatusOr<std::vector<Image>> render(const std::vector<JobSpec>& specs) {
    std::vector<JobId> jobs;
    for (const JobSpec& spec : specs) {
      ASSIGN_OR_RETURN(const JobId job, submit(client_, spec, priority_));
      jobs.push_back(job);
    }
    std::vector<Image> images;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      ASSIGN_OR_RETURN(Image image, image_of(jobs[i], specs[i]));
      images.push_back(std::move(image));
    }
    return images;
  }

 private:
  /// Waits for the job and returns its image. The request id in `spec` is the same for all users
  /// who need this image. So `job` may be an earlier job that was cancelled or has failed; then a
  /// new one is submitted. ABORTED: the new one is cancelled or fails as well.
  absl::StatusOr<Image> image_of(JobId job, JobSpec spec) {
    ASSIGN_OR_RETURN(Progress last, follow_job(client_, job, display_));
    if (last.job.state != JobState::kDone) {
      spec.request_id = link::random_hex(16);
      ASSIGN_OR_RETURN(job, submit(client_, spec, priority_));
      ASSIGN_OR_RETURN(last, follow_job(client_, job, display_));
    }
    if (last.job.state != JobState::kDone) {
      return absl::AbortedError(absl::StrCat("job ", job, ", which the clean image needs, ",
                                             state_name(last.job.state),
                                             last.job.reason.empty() ? "" : ": ", last.job.reason));
    }
    ASSIGN_OR_RETURN(FarmImage result,
                     call_with_retries(client_, [&] { return client_.result(job); }));
    return std::move(result.image);
  }

  FarmClient& client_;
  const std::int32_t priority_;
  ProgressDisplay& display_;
};

/// Fetches the mean of the first part (about half) of each pixel's samples, by which the filter
/// estimates the noise. Returns std::nullopt if the image has at most one block of samples (8),
/// which has no parts.
absl::StatusOr<std::optional<Film::FirstPart>> first_part_of(FarmClient& client,
                                                             const JobView& job) {
  if (first_part_samples(job.samples_per_pixel) == 0) {
    return std::nullopt;
  }
  ASSIGN_OR_RETURN(Image mean,
                   call_with_retries(client, [&] { return client.first_part(job.id); }));
  if (!is_adaptive(job.spec.stop)) {
    std::vector<float> shares = first_part_shares(job.samples_per_pixel, mean.pixels.size());
    return Film::FirstPart{std::move(mean), std::move(shares)};
  }
  ASSIGN_OR_RETURN(const Image counts,
                   call_with_retries(client, [&] { return client.samples(job.id); }));
  return Film::FirstPart{std::move(mean), first_part_shares(counts)};
}

}  // namespace

absl::Status start_guides(FarmClient& client, const Progress& last) {
  const JobView& job = last.job;
  RETURN_IF_ERROR(check_cleanable(job.spec.settings, job.samples_per_pixel));
  const CleanJobs jobs = clean_jobs(job.spec, job.samples_per_pixel);
  const std::int32_t priority = std::min(job.priority + 1, kMaxPriority);
  RETURN_IF_ERROR(submit(client, jobs.albedo, priority).status());
  RETURN_IF_ERROR(submit(client, jobs.shape, priority).status());
  // An image of at most one block of samples has no first part, but needs further samples.
  return jobs.further ? submit(client, *jobs.further, priority).status() : absl::OkStatus();
}

absl::StatusOr<Denoised> clean_job(FarmClient& client, const Progress& last, const Image& image,
                                   Denoiser denoiser, ProgressDisplay& display) {
  const JobView& job = last.job;
  RETURN_IF_ERROR(check_cleanable(job.spec.settings, job.samples_per_pixel));
  ASSIGN_OR_RETURN(std::optional<Film::FirstPart> first, first_part_of(client, job));
  FarmRenderer renderer(client, job.priority, display);
  Pool pool(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  return make_clean(
      {image, std::move(first), job.spec, job.samples_per_pixel},
      [&](const std::vector<JobSpec>& jobs) { return renderer.render(jobs); }, denoiser,
      *kernels().front(), pool);
}

}  // namespace bandsaw::coordinator
