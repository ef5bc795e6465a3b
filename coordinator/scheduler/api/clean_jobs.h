#pragma once

// The jobs that the denoiser of a job's image needs (renderlib/denoise): two guides, which are
// images of the albedo and of the normals and distances of the surfaces, and for an image of few
// samples one half of its samples. Used by `--denoise` of the commands and by the dashboard.

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "coordinator/scheduler/api/job_spec.h"

namespace bandsaw::coordinator {

/// Returns the name of a job that is made beside another job: `name`, which is that of the other
/// job, then `suffix`, which has at most a few words. If both together would be longer than the
/// name of a job may be, `name` is cut between characters.
std::string with_suffix(const std::string& name, const std::string& suffix);

/// Bounds of the number of samples of the guides.
inline constexpr std::uint64_t kMinGuideSamples = 8;
inline constexpr std::uint64_t kMaxGuideSamples = 32;

/// Returns the number of samples per pixel of the guides of an image with `samples` samples, at
/// least 1: about a quarter as many, within the bounds, and not more than the image has. More
/// samples would improve the clean image too little for the time that they cost
/// (renderlib/denoise/NOTES.md). The number is a power of two unless the image has fewer than 8
/// samples, so an image that is rendered further rarely needs new guides.
std::uint64_t guide_samples(std::uint64_t samples);

/// Checks if an image with this many samples per pixel can be denoised. FAILED_PRECONDITION: the
/// integrator computes no radiance, or the pixels have a single sample.
absl::Status check_cleanable(const RenderSettings& settings, std::uint64_t samples);

/// The specifications of these jobs.
struct CleanJobs {
  JobSpec albedo;
  JobSpec shape;  ///< normals and distances
  /// Renders the first half of the image's samples again, because the denoiser estimates the noise
  /// from a part of the samples. std::nullopt: not needed, because an image of more than one block
  /// of samples (8) has kept the sum of its first part.
  std::optional<JobSpec> half;
};

/// Returns the jobs for the image of a job that has `samples` samples per pixel, at least 2. Their
/// request ids depend on what they render only, so that one image of guides serves all users and
/// all images of the same scene, size and seed.
CleanJobs clean_jobs(const JobSpec& of, std::uint64_t samples);

}  // namespace bandsaw::coordinator
