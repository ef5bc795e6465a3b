#include "coordinator/cli/image/clean.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "absl/strings/match.h"
#include "coordinator/cli/image/output.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw::coordinator {
namespace {

bool is_exr(const std::string& output) { return absl::EndsWithIgnoreCase(output, ".exr"); }

std::string raw_name(const std::string& output) {
  std::filesystem::path path(output);
  const std::string suffix = path.extension().string();
  return path.replace_extension(".raw" + suffix).string();
}

/// Renders the first half of the samples again: a block has no parts.
absl::StatusOr<Film::FirstPart> render_first_part(const ToClean& input,
                                                  const LayerRenderer& render) {
  if (input.samples < 2) {
    return absl::FailedPreconditionError(
        "--denoise: the error of one sample per pixel cannot be estimated; take 2 or more");
  }
  const std::uint64_t part = input.samples / 2;
  ASSIGN_OR_RETURN(Image mean, render(input.settings, part));
  const auto share =
      static_cast<float>(static_cast<double>(part) / static_cast<double>(input.samples));
  std::vector<float> shares(mean.pixels.size(), share);
  return Film::FirstPart{std::move(mean), std::move(shares)};
}

}  // namespace

absl::StatusOr<Denoised> make_clean(ToClean input, const LayerRenderer& render,
                                    const Kernel& kernel, Pool& pool) {
  if (!input.first) {
    ASSIGN_OR_RETURN(input.first, render_first_part(input, render));
  }
  RenderSettings settings = input.settings;
  const std::uint64_t samples = std::min(input.samples, kMaxGuideSamples);
  settings.integrator = kGuideAlbedo;
  ASSIGN_OR_RETURN(Image albedo, render(settings, samples));
  settings.integrator = kGuideShape;
  ASSIGN_OR_RETURN(Image shape, render(settings, samples));
  const DenoiseInput of_filter{.mean = input.mean,
                               .first = std::move(input.first->mean),
                               .first_share = std::move(input.first->share),
                               .albedo = std::move(albedo),
                               .shape = std::move(shape)};
  return denoise(of_filter, kernel.fit, pool);
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
