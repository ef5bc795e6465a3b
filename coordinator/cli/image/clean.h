#pragma once

// Removes the noise of an image (renderlib/denoise) and writes the clean image beside the image as
// rendered. The filter needs guides: images of the albedo and of the shape of the surfaces, which
// have little noise.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/image/layers.h"
#include "coordinator/cli/image/report.h"
#include "coordinator/cli/options/options.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "renderlib/denoise/denoise.h"
#include "renderlib/image/display.h"
#include "renderlib/image/layers.h"
#include "renderlib/render/film.h"
#include "renderlib/render/kernel.h"

namespace bandsaw::coordinator {

/// An image that is to be cleaned.
struct ToClean {
  const Image& mean;                     ///< as rendered
  std::optional<Film::FirstPart> first;  ///< std::nullopt: it is rendered, from half of the samples
  const JobSpec& spec;                   ///< specification of the image's job
  std::uint64_t samples = 0;             ///< per pixel
};

/// Renders the images of these jobs, here or on a farm, in the same order.
using JobRenderer =
    std::function<absl::StatusOr<std::vector<Image>>(const std::vector<JobSpec>& jobs)>;

/// Renders jobs that stop at a number of samples, one after the other, by `render`.
JobRenderer one_by_one(LayerRenderer render);

/// Renders the guides, and the first part if it is missing, and removes the noise, by
/// OpenImageDenoise for kOidn. FAILED_PRECONDITION: the image cannot be cleaned (check_cleanable);
/// other errors: those of `render` and of Oidn.
absl::StatusOr<Denoised> make_clean(ToClean input, const JobRenderer& render, Denoiser denoiser,
                                    const Kernel& kernel, Pool& pool);

/// Returns the entry of the report for an image cleaned by `denoiser` and written to `outputs`.
Report::Clean clean_report(const Denoised& clean, Denoiser denoiser,
                           const std::vector<std::string>& outputs);

/// Checks before an image is rendered if it can be cleaned; OK for kNone. FAILED_PRECONDITION as
/// check_cleanable; UNAVAILABLE: OpenImageDenoise is not installed.
absl::Status check_denoise(Denoiser denoiser, const RenderSettings& settings, const StopRule& stop);

/// Returns the files that hold the image as rendered beside these outputs: picture.raw.png beside
/// picture.png. EXR files hold both images and need none.
std::vector<std::string> raw_outputs(const std::vector<std::string>& outputs);

/// Checks the files of an image before it is rendered: `outputs`, of which the user named `given`
/// (check_outputs), and raw_outputs() if the image is cleaned. Returns the files of its report.
/// Errors: those of check_outputs and of report_files.
absl::StatusOr<std::vector<std::string>> check_image_files(const std::string& scene,
                                                           const std::vector<std::string>& given,
                                                           const std::vector<std::string>& outputs,
                                                           Denoiser denoiser,
                                                           const ReportOption& report);

/// Writes the clean image to the outputs and the image as rendered to raw_outputs(). EXR files get
/// the layers `raw` and `error` besides `layers`. Tries all files and returns the first error.
absl::Status write_clean_outputs(const Denoised& clean, const Image& raw,
                                 const std::vector<std::string>& outputs, const Display& display,
                                 Layers layers);

}  // namespace bandsaw::coordinator
