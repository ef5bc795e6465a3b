#pragma once

// Layers of an EXR file: pictures of the same scene by integrators that follow no light.

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options.h"
#include "renderlib/base/pool.h"
#include "renderlib/image/layers.h"
#include "renderlib/render/settings.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {

/// More samples than these make a layer no better to look at.
inline constexpr std::uint64_t kMostLayerSamples = 64;

/// "albedo,normal,depth,samples": each at most once. INVALID_ARGUMENT.
absl::StatusOr<std::vector<LayerKind>> parse_layers(const std::string& list);

/// Renders them with the image's settings and min(`samples`, kMostLayerSamples) samples: to the bit
/// what `--integrator albedo`, `normals` and `depth` give for that number. `samples` is what the
/// image has; of kSamples each pixel's number. CANCELLED; RESOURCE_EXHAUSTED: no memory.
absl::StatusOr<Layers> render_layers(const std::vector<LayerKind>& kinds, const Scene& scene,
                                     RenderSettings settings, std::uint64_t samples, Pool& pool,
                                     const std::atomic<bool>& stop);

}  // namespace bandsaw::coordinator
