#pragma once

// Layers of an EXR file: additional pictures of the same scene by integrators without light
// transport.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "renderlib/image/layers.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {

/// More samples than this do not visibly improve a layer.
inline constexpr std::uint64_t kMaxLayerSamples = 64;

/// Renders the scene with these settings and this number of samples, here or on a farm.
using LayerRenderer =
    std::function<absl::StatusOr<Image>(const RenderSettings& settings, std::uint64_t samples)>;

/// Returns the number of samples of each pixel of an adaptive image.
using SampleCounts = std::function<absl::StatusOr<Image>()>;

/// Renders the layers with the image's settings and min(`samples`, kMaxLayerSamples) samples, with
/// the same bits as `--integrator albedo`, `normals` and `depth` for that number. `samples` is the
/// image's number of samples per pixel; layer kSamples shows it if there are no `counts`. Returns
/// errors of `render` and `counts`.
absl::StatusOr<Layers> make_layers(const std::vector<LayerKind>& kinds, RenderSettings settings,
                                   std::uint64_t samples, const LayerRenderer& render,
                                   const SampleCounts& counts);

}  // namespace bandsaw::coordinator
