#pragma once

// Layers of an EXR file: pictures of the same scene by integrators that follow no light.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "renderlib/image/layers.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {

/// More samples than these make a layer no better to look at.
inline constexpr std::uint64_t kMostLayerSamples = 64;

/// "albedo", "normal", "depth", "samples".
std::vector<std::string> layer_names();

/// "albedo,normal,depth,samples": each at most once. INVALID_ARGUMENT.
absl::StatusOr<std::vector<LayerKind>> parse_layers(const std::string& list);

/// Renders the scene by these settings with so many samples, here or on a farm.
using LayerRenderer =
    std::function<absl::StatusOr<Image>(const RenderSettings& settings, std::uint64_t samples)>;

/// How many samples each pixel of an adaptive image has.
using SampleCounts = std::function<absl::StatusOr<Image>()>;

/// Has them rendered with the image's settings and min(`samples`, kMostLayerSamples) samples: to
/// the bit what `--integrator albedo`, `normals` and `depth` give for that number. `samples` is
/// what the image has: kSamples shows it where there are no `counts`. Errors are those of `render`
/// and `counts`.
absl::StatusOr<Layers> make_layers(const std::vector<LayerKind>& kinds, RenderSettings settings,
                                   std::uint64_t samples, const LayerRenderer& render,
                                   const SampleCounts& counts);

}  // namespace bandsaw::coordinator
