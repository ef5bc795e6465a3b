#pragma once

// The jobs that the denoiser (renderlib/denoise) needs in addition to the job of the image. Two of
// them render the guides: an image of the albedo, and an image of the normals and distances of the
// surfaces. For an image of few samples, a third job renders further samples. Used by `--denoise`
// of the commands and by the dashboard.

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "coordinator/scheduler/api/job_spec.h"

namespace bandsaw::coordinator {

/// Returns the name of a job that is made in addition to another job: first `name`, which is the
/// name of the other job, then `suffix`, a few words. If this is longer than the name of a job may
/// be, `name` is shortened by whole characters.
std::string with_suffix(const std::string& name, const std::string& suffix);

/// Checks if an image with this many samples per pixel can be denoised. FAILED_PRECONDITION: the
/// integrator computes no radiance, or the pixels have a single sample.
absl::Status check_cleanable(const RenderSettings& settings, std::uint64_t samples);

/// The specifications of the jobs that the denoiser needs.
struct CleanJobs {
  JobSpec albedo;
  JobSpec shape;  ///< normals and distances
  /// Renders half as many samples as the image has, with another seed. The denoiser estimates the
  /// noise from two independent parts of the samples, but the samples of one block (8) or less are
  /// only kept as a sum. The further samples are the other part (renderlib/denoise/halves.h,
  /// add_samples). std::nullopt: not needed, because the job has more than one block of samples.
  std::optional<JobSpec> further;
};

/// Returns the number of further samples for an image of `samples` samples per pixel, as above; 0:
/// not needed.
std::uint64_t further_samples(std::uint64_t samples);

/// Returns the jobs for the image of a job that has `samples` samples per pixel, at least 2. Their
/// request ids depend only on what they render. So all users and all images of the same scene, size
/// and seed share one job for each guide.
CleanJobs clean_jobs(const JobSpec& of, std::uint64_t samples);

}  // namespace bandsaw::coordinator
