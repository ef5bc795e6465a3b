// The names of the integrators are a table in the order of the enum.

#include "renderlib/scene/integrator.h"

#include <array>

#include "renderlib/scene/guide_integrators.h"

namespace bandsaw {
namespace {

constexpr std::array<absl::string_view, kLastGuideIntegrator + 1> kNames = {
    "path",        "direct",          "normals",
    "depth",       "albedo",          "ambient_occlusion",
    "path_lights", "path_scattering", "path_guided",
    "path_plain",  "guide_albedo",    "guide_shape"};

}  // namespace

absl::string_view integrator_name(Integrator integrator) {
  return kNames[static_cast<std::size_t>(integrator)];
}

std::optional<Integrator> integrator_named(absl::string_view name) {
  for (std::size_t i = 0; i <= kLastIntegrator; ++i) {
    if (kNames[i] == name) {
      return static_cast<Integrator>(i);
    }
  }
  return std::nullopt;
}

}  // namespace bandsaw
