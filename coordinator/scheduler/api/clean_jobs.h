#pragma once

// The jobs whose images are needed to remove the noise of a job's image (renderlib/denoise): the
// guides, which are images of the albedo and of the shape of the surfaces, and sometimes one half
// of the samples.

#include <cstdint>
#include <optional>

#include "absl/status/status.h"
#include "coordinator/scheduler/api/job_spec.h"

namespace bandsaw::coordinator {

/// Bounds of the number of samples of the guides.
inline constexpr std::uint64_t kMinGuideSamples = 8;
inline constexpr std::uint64_t kMaxGuideSamples = 32;

/// Returns the number of samples per pixel of the guides of an image with `samples` samples, at
/// least 1: about a quarter as many, within the bounds, and not more than the image has. More would
/// cost more time than they improve the clean image (renderlib/denoise/NOTES.md). It is a power of
/// two unless the image has fewer than 8 samples, so that an image which goes on being rendered
/// needs new guides seldom.
std::uint64_t guide_samples(std::uint64_t samples);

/// Checks if an image with this many samples per pixel can be cleaned. FAILED_PRECONDITION: the
/// integrator computes no radiance, or the pixels have a single sample.
absl::Status check_cleanable(const RenderSettings& settings, std::uint64_t samples);

struct CleanJobs {
  JobSpec albedo;
  JobSpec shape;
  /// Renders the first half of the image's samples again. Only needed for an image of at most one
  /// block of samples, whose sum is not kept in parts.
  std::optional<JobSpec> half;
};

/// Returns the jobs for the image of a job that has `samples` samples per pixel, at least 2. Their
/// request ids depend on what they render only, so that one image of guides serves all users and
/// all images of the same scene, size and seed.
CleanJobs clean_jobs(const JobSpec& of, std::uint64_t samples);

}  // namespace bandsaw::coordinator
