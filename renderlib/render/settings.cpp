// Checks the ranges of render settings.

#include "renderlib/render/settings.h"

#include "absl/strings/str_cat.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw {
namespace {

absl::Status out_of_range(absl::string_view field, std::uint64_t most, std::uint64_t found) {
  return absl::InvalidArgumentError(
      absl::StrCat(field, ": must be in [1, ", most, "], is ", found));
}

}  // namespace

absl::Status validate(const RenderSettings& settings) {
  if (settings.width < 1 || settings.width > kMaxSide) {
    return out_of_range("width", kMaxSide, settings.width);
  }
  if (settings.height < 1 || settings.height > kMaxSide) {
    return out_of_range("height", kMaxSide, settings.height);
  }
  const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
  if (pixels > kMaxPixels) {
    return out_of_range("width x height", kMaxPixels, pixels);
  }
  if (settings.max_depth < 1 || settings.max_depth > kMaxDepth) {
    return out_of_range("max_depth", kMaxDepth, settings.max_depth);
  }
  // is_guide() is true for the integrators that the denoiser uses. They are valid, but the error
  // does not name them, because users cannot select them.
  const auto integrator = static_cast<int>(settings.integrator);
  if (integrator < 0 || (integrator > kLastIntegrator && !is_guide(settings.integrator))) {
    return absl::InvalidArgumentError(
        absl::StrCat("integrator: must be in [0, ", kLastIntegrator, "], is ", integrator));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
