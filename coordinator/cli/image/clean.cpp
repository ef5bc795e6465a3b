// Removes the noise of images by renderlib/denoise or by OpenImageDenoise (oidn.h), and writes the
// clean images beside the images as rendered.

#include "coordinator/cli/image/clean.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "coordinator/cli/image/oidn.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/image/report_file.h"
#include "coordinator/scheduler/api/clean_jobs.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/denoise/halves.h"

namespace bandsaw::coordinator {
namespace {

bool is_exr(const std::string& output) { return absl::EndsWithIgnoreCase(output, ".exr"); }

/// Returns the absolute path of a file, so that two names of one file can be compared. Links and
/// ".." are resolved in the path of its folder only: if the file itself is a link, writing replaces
/// the link. Returns `file` if the folder cannot be resolved.
std::filesystem::path full_name(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::absolute(file, error);
  if (error) {
    return file;
  }
  const auto folder = std::filesystem::weakly_canonical(full.parent_path(), error);
  return error ? file : folder / full.filename();
}

/// Returns the name of the file for the image as rendered: "picture.png" -> "picture.raw.png".
std::string raw_name(const std::string& output) {
  std::filesystem::path path(output);
  const std::string suffix = path.extension().string();
  return path.replace_extension(".raw" + suffix).string();
}

/// Returns the normals in the camera's view as unit vectors, or zeros where no surface was hit. In
/// `shape`, red is (x + 1) / 2 and green is (y + 1) / 2 of the normal (x, y, z). Blue is the
/// distance of the surface, or 0 where no surface was hit. z is computed from the length, 1.
Image normals_of(const Image& shape) {
  Image normals{shape.width, shape.height, {}};
  for (const Rgb& guide : shape.pixels) {
    const float x = 2 * guide.r - 1;
    const float y = 2 * guide.g - 1;
    const float z = std::sqrt(std::max(0.0f, 1 - x * x - y * y));
    normals.pixels.push_back(guide.b > 0 ? Rgb{x, y, z} : Rgb{});
  }
  return normals;
}

/// Filters the image by OpenImageDenoise. The samples of the image are divided into two parts. The
/// mean of each part is filtered too, because the error of the clean image is estimated from the
/// results.
absl::StatusOr<Denoised> clean_by_oidn(const DenoiseInput& input, Pool& pool) {
  ASSIGN_OR_RETURN(const Oidn oidn, Oidn::load());
  const Image normals = normals_of(input.shape);
  const auto filter = [&](const Image& color) { return oidn.filter(color, input.albedo, normals); };
  ASSIGN_OR_RETURN(Image clean, filter(input.mean));
  ASSIGN_OR_RETURN(const Image first, filter(input.first));
  ASSIGN_OR_RETURN(const Image second, filter(second_part(input)));
  return with_error_of_halves(input, std::move(clean), first, second, pool);
}

}  // namespace

JobRenderer one_by_one(LayerRenderer render) {
  return [render = std::move(render)](
             const std::vector<JobSpec>& jobs) -> absl::StatusOr<std::vector<Image>> {
    std::vector<Image> images;
    for (const JobSpec& job : jobs) {
      ASSIGN_OR_RETURN(Image image,
                       render(job.settings, std::get<StopAtSamples>(job.stop).samples));
      images.push_back(std::move(image));
    }
    return images;
  };
}

absl::StatusOr<Denoised> make_clean(ToClean input, const JobRenderer& render, Denoiser denoiser,
                                    const Kernel& kernel, Pool& pool) {
  RETURN_IF_ERROR(check_cleanable(input.spec.settings, input.samples));
  CleanJobs jobs = clean_jobs(input.spec, input.samples);
  std::vector<JobSpec> wanted = {std::move(jobs.albedo), std::move(jobs.shape)};
  const bool has_parts = input.first.has_value();
  if (!has_parts) {
    wanted.push_back(*std::move(jobs.further));
  }
  ASSIGN_OR_RETURN(std::vector<Image> images, render(wanted));
  DenoiseInput of_filter;
  of_filter.albedo = std::move(images[0]);
  of_filter.shape = std::move(images[1]);
  if (has_parts) {
    of_filter.mean = input.mean;
    of_filter.first = std::move(input.first->mean);
    of_filter.first_share = std::move(input.first->share);
  } else {
    add_samples(input.mean, static_cast<double>(input.samples), std::move(images[2]),
                static_cast<double>(further_samples(input.samples)), of_filter);
  }
  return denoiser == Denoiser::kOidn ? clean_by_oidn(of_filter, pool)
                                     : denoise(of_filter, kernel.fit, pool);
}

Report::Clean clean_report(const Denoised& clean, Denoiser denoiser,
                           const std::vector<std::string>& outputs) {
  const bool own = denoiser != Denoiser::kOidn;
  return {.error = clean.total,
          .method = own ? "regression" : "oidn",
          .same_bits = own,
          .pixels_sha256 = pixels_sha256(clean.image),
          .raw_outputs = raw_outputs(outputs)};
}

absl::Status check_denoise(Denoiser denoiser, const RenderSettings& settings,
                           const StopRule& stop) {
  // The number of samples of a job that stops at an error or a time is not known yet. The job has
  // at least kBlockSamples, which are enough.
  const auto* until = std::get_if<StopAtSamples>(&stop);
  absl::Status status;
  if (denoiser != Denoiser::kNone) {
    status = check_cleanable(settings, until != nullptr ? until->samples : kBlockSamples);
  }
  if (denoiser == Denoiser::kOidn) {
    status.Update(Oidn::load().status());
  }
  return status.ok() ? status
                     : absl::Status(status.code(), absl::StrCat("--denoise: ", status.message()));
}

std::vector<std::string> raw_outputs(const std::vector<std::string>& outputs) {
  std::vector<std::string> raw;
  for (const std::string& output : outputs) {
    if (!is_exr(output)) {
      raw.push_back(raw_name(output));
    }
  }
  return raw;
}

absl::Status check_raw_outputs(const std::vector<std::string>& outputs) {
  const std::vector<std::string> raw_files = raw_outputs(outputs);
  for (const std::string& raw : raw_files) {
    const auto is_raw = [&](const std::string& output) {
      return full_name(output) == full_name(raw);
    };
    if (std::any_of(outputs.begin(), outputs.end(), is_raw)) {
      return absl::InvalidArgumentError(absl::StrCat(
          "-o ", raw, ": --denoise writes the image as rendered to this file; name another one"));
    }
  }
  return check_outputs_writable(raw_files);
}

absl::StatusOr<std::vector<std::string>> check_image_files(const std::string& scene,
                                                           const std::vector<std::string>& given,
                                                           const std::vector<std::string>& outputs,
                                                           Denoiser denoiser,
                                                           const ReportOption& report) {
  RETURN_IF_ERROR(check_outputs(scene, given, outputs));
  if (denoiser != Denoiser::kNone) {
    RETURN_IF_ERROR(check_raw_outputs(outputs));
  }
  return report_files(report, outputs);
}

absl::Status write_clean_outputs(const Denoised& clean, const Image& raw,
                                 const std::vector<std::string>& outputs, const Display& display,
                                 Layers layers) {
  layers.push_back({.name = "raw", .image = raw});
  layers.push_back({.name = "error", .image = clean.error, .is_number = true});
  absl::Status first = write_outputs(clean.image, outputs, display, layers);
  first.Update(write_outputs(raw, raw_outputs(outputs), display));
  return first;
}

}  // namespace bandsaw::coordinator
