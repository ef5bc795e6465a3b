#include "coordinator/cli/image_settings.h"

#include <algorithm>

#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

// value x numerator / denominator, to the nearest whole number, at least 1. A result past kMaxSide
// is left for validate.
std::uint32_t scaled(std::uint32_t value, std::uint32_t numerator, std::uint32_t denominator) {
  const std::uint64_t exact =
      (2 * std::uint64_t{value} * numerator + denominator) / (2 * std::uint64_t{denominator});
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(exact, 1, kMaxSide + 1));
}

}  // namespace

absl::StatusOr<RenderSettings> image_settings(const ImageOptions& options,
                                              const PackageInfo& scene) {
  RenderSettings settings{.width = options.width.value_or(scene.width),
                          .height = options.height.value_or(scene.height),
                          .max_depth = options.depth.value_or(scene.max_depth),
                          .seed = options.seed,
                          .integrator = options.integrator.value_or(scene.integrator)};
  if (options.width && !options.height) {
    settings.height = scaled(*options.width, scene.height, scene.width);
  } else if (options.height && !options.width) {
    settings.width = scaled(*options.height, scene.width, scene.height);
  }
  RETURN_IF_ERROR(validate(settings));
  return settings;
}

}  // namespace bandsaw::coordinator
