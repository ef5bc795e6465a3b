// clean_jobs() returns the jobs whose images the denoiser needs in addition to the image itself:
// the guides (images of the albedo, and of the normals and distances), and for few samples also an
// image of further samples. The request id of such a job is a hash of what it renders. So if
// several users need the same image, they share one job.

#include "coordinator/scheduler/api/clean_jobs.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/render/band.h"
#include "renderlib/render/pixel_version.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw::coordinator {
namespace {

/// The seed of further samples is the image's seed with these bits inverted. The number is
/// arbitrary; it is large, so that users rarely render the same scene with that seed.
constexpr std::uint64_t kFurtherSeed = 0x6d4f3a9c51e7;

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

std::uint64_t further_samples(std::uint64_t samples) {
  return samples <= kBlockSamples ? samples / 2 : 0;
}

CleanJobs clean_jobs(const JobSpec& of, std::uint64_t samples) {
  CleanJobs jobs{.albedo = beside(of, kGuideAlbedo, kGuideSamples, " (guide: albedo)"),
                 .shape = beside(of, kGuideShape, kGuideSamples, " (guide: shape)"),
                 .further = std::nullopt};
  if (const std::uint64_t further = further_samples(samples); further > 0) {
    JobSpec other_seed = of;
    other_seed.settings.seed ^= kFurtherSeed;
    jobs.further = beside(other_seed, of.settings.integrator, further, " (further samples)");
  }
  return jobs;
}

}  // namespace bandsaw::coordinator
