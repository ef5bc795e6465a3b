// settings_of() takes from the package all settings that the caller did not state.

#include "renderlib/package/settings_of.h"

#include <algorithm>

namespace bandsaw {
namespace {

// Returns value x numerator / denominator, rounded to the nearest integer and limited to
// [1, kMaxSide + 1]. validate(RenderSettings) refuses the result kMaxSide + 1.
std::uint32_t scaled(std::uint32_t value, std::uint32_t numerator, std::uint32_t denominator) {
  const std::uint64_t exact =
      (2 * std::uint64_t{value} * numerator + denominator) / (2 * std::uint64_t{denominator});
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(exact, 1, kMaxSide + 1));
}

}  // namespace

RenderSettings settings_of(const PackageInfo& scene, std::optional<std::uint32_t> width,
                           std::optional<std::uint32_t> height) {
  RenderSettings settings{.width = width.value_or(scene.width),
                          .height = height.value_or(scene.height),
                          .max_depth = scene.max_depth,
                          .integrator = scene.integrator};
  if (width && !height) {
    settings.height = scaled(*width, scene.height, scene.width);
  } else if (height && !width) {
    settings.width = scaled(*height, scene.width, scene.height);
  }
  return settings;
}

}  // namespace bandsaw
