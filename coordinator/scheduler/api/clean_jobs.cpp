// clean_jobs() returns the jobs whose images the denoiser needs in addition to the image itself:
// the guides (images of the albedo, and of the normals and distances), and for few samples also an
// image of half of the samples. The request id of such a job is a hash of what it renders. So if
// several users need the same image, they share one job.

#include "coordinator/scheduler/api/clean_jobs.h"

#include <algorithm>
#include <bit>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/render/band.h"
#include "renderlib/render/pixel_version.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw::coordinator {
namespace {

/// Returns a job like `of`, but with another integrator and number of samples, and a name with this
/// suffix.
JobSpec beside(const JobSpec& of, Integrator integrator, std::uint64_t samples,
               const std::string& suffix) {
  JobSpec spec = of;
  spec.settings.integrator = integrator;
  spec.stop = StopAtSamples{samples};
  spec.name = with_suffix(of.name, suffix);
  spec.request_id = absl::StrFormat("clean-%d-%016x-%d", kPixelVersion,
                                    work_hash(spec.manifest, spec.settings), samples);
  return spec;
}

}  // namespace

std::string with_suffix(const std::string& name, const std::string& suffix) {
  return clean_text(name, wire::kJobNameBytes - suffix.size()) + suffix;
}

absl::Status check_cleanable(const RenderSettings& settings, std::uint64_t samples) {
  if (!computes_radiance(settings.integrator)) {
    return absl::FailedPreconditionError(
        absl::StrCat("images of the integrator ", integrator_name(settings.integrator),
                     " are not cleaned: only images of light are denoised"));
  }
  if (samples < 2) {
    return absl::FailedPreconditionError(
        "the error of one sample per pixel cannot be estimated, so the image is not cleaned; take "
        "2 samples or more");
  }
  return absl::OkStatus();
}

std::uint64_t guide_samples(std::uint64_t samples) {
  const std::uint64_t quarter = std::bit_floor(samples / 4);
  return std::min(samples, std::clamp(quarter, kMinGuideSamples, kMaxGuideSamples));
}

CleanJobs clean_jobs(const JobSpec& of, std::uint64_t samples) {
  const std::uint64_t of_guides = guide_samples(samples);
  CleanJobs jobs{.albedo = beside(of, kGuideAlbedo, of_guides, " (guide: albedo)"),
                 .shape = beside(of, kGuideShape, of_guides, " (guide: shape)"),
                 .half = std::nullopt};
  if (samples <= kBlockSamples) {
    jobs.half = beside(of, of.settings.integrator, samples / 2, " (half of the samples)");
  }
  return jobs;
}

}  // namespace bandsaw::coordinator
