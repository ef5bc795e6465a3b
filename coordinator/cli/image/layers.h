#pragma once

// Makes the additional layers of an EXR file, for --layers of `render` and `submit`: pictures of
// the same view by integrators without light transport (albedo, normals, depth), and the number of
// samples of each pixel.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "renderlib/image/layers.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {

/// Maximum number of samples per pixel of a layer. More samples do not visibly improve a layer.
inline constexpr std::uint64_t kMaxLayerSamples = 64;

/// A function that renders the scene with these settings and this number of samples per pixel, on
/// this machine or on a farm.
using LayerRenderer =
    std::function<absl::StatusOr<Image>(const RenderSettings& settings, std::uint64_t samples)>;

/// A function that returns the number of samples of each pixel of an adaptive image.
using SampleCounts = std::function<absl::StatusOr<Image>()>;

/// Returns a layer for each of `kinds`. `settings` and `samples` (per pixel) are those of the
/// image. The layers are rendered with at most kMaxLayerSamples samples. They have the same bits as
/// images that `--integrator albedo`, `normals` and `depth` render with the same number of samples.
/// The layer kSamples is the result of `counts`; if `counts` is empty, all its pixels are
/// `samples`. Returns errors of `render` and `counts`.
absl::StatusOr<Layers> make_layers(const std::vector<LayerKind>& kinds, RenderSettings settings,
                                   std::uint64_t samples, const LayerRenderer& render,
                                   const SampleCounts& counts);

}  // namespace bandsaw::coordinator
