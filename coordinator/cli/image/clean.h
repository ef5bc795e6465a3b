#pragma once

// Removes the noise of an image (renderlib/denoise) and writes the clean image beside the image as
// rendered, for --denoise of `render`, `submit` and `watch`. The filter needs guides: images of the
// albedo and of the shape of the surfaces. The guides have little noise, so the filter finds edges
// by them.

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
  const Image& mean;  ///< as rendered: the mean of all samples of each pixel
  /// The mean of about half of each pixel's samples, by which the noise is estimated. std::nullopt:
  /// make_clean() renders further samples (CleanJobs::further).
  std::optional<Film::FirstPart> first;
  const JobSpec& spec;        ///< specification of the image's job
  std::uint64_t samples = 0;  ///< per pixel
};

/// A function that renders jobs, on this machine or on a farm, and returns their images in the same
/// order.
using JobRenderer =
    std::function<absl::StatusOr<std::vector<Image>>(const std::vector<JobSpec>& jobs)>;

/// Returns a function that renders jobs one after the other by `render`. All jobs MUST stop at a
/// number of samples.
JobRenderer one_by_one(LayerRenderer render);

/// Renders the guides, and `input.first` if it is missing, by `render`. Then removes the noise: by
/// OpenImageDenoise for kOidn, otherwise by renderlib/denoise with `kernel` (the renderer's code
/// for one instruction set). FAILED_PRECONDITION: the image cannot be cleaned (check_cleanable).
/// Other errors: those of `render` and of Oidn.
absl::StatusOr<Denoised> make_clean(ToClean input, const JobRenderer& render, Denoiser denoiser,
                                    const Kernel& kernel, Pool& pool);

/// Returns what the report states about a clean image that was made by `denoiser` and written to
/// `outputs`.
Report::Clean clean_report(const Denoised& clean, Denoiser denoiser,
                           const std::vector<std::string>& outputs);

/// Checks, before an image is rendered, whether its noise can be removed. Returns OK for kNone.
/// FAILED_PRECONDITION: the image cannot be cleaned (check_cleanable in
/// scheduler/api/clean_jobs.h). UNAVAILABLE: OpenImageDenoise is wanted and not installed.
absl::Status check_denoise(Denoiser denoiser, const RenderSettings& settings, const StopRule& stop);

/// Returns the files that get the image as rendered: picture.raw.png beside the output picture.png,
/// which gets the clean image. An EXR file has both images, so it needs no other file.
std::vector<std::string> raw_outputs(const std::vector<std::string>& outputs);

/// Checks that raw_outputs(outputs) can be written. INVALID_ARGUMENT: one of them is among
/// `outputs`. Other errors: those of check_outputs_writable.
absl::Status check_raw_outputs(const std::vector<std::string>& outputs);

/// Checks, before an image is rendered, that its files can be written: `outputs`, and raw_outputs()
/// if the noise is removed. `given`: the outputs that the user named; empty: `outputs` are
/// defaults. Returns the files of the report. Errors: those of check_outputs, of check_raw_outputs
/// and of report_files.
absl::StatusOr<std::vector<std::string>> check_image_files(const std::string& scene,
                                                           const std::vector<std::string>& given,
                                                           const std::vector<std::string>& outputs,
                                                           Denoiser denoiser,
                                                           const ReportOption& report);

/// Writes the clean image to the outputs, and `raw`, the image as rendered, to raw_outputs(). EXR
/// files get the layers `raw` and `error` in addition to `layers`. Tries to write all files and
/// returns the first error.
absl::Status write_clean_outputs(const Denoised& clean, const Image& raw,
                                 const std::vector<std::string>& outputs, const Display& display,
                                 Layers layers);

}  // namespace bandsaw::coordinator
