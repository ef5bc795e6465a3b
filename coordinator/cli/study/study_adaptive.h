#pragma once

// Renders an adaptive image with about a given number of samples per pixel: like `--error E
// --adaptive`, for a study with a fixed number of samples.

#include <atomic>
#include <cstdint>

#include "absl/status/statusor.h"
#include "renderlib/base/pool.h"
#include "renderlib/image/image.h"
#include "renderlib/render/settings.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {

struct AdaptiveImage {
  Image image;
  /// Samples per pixel, on average: the requested number or slightly more.
  double samples = 0;
  double rays = 0;
};

/// The pilot pass takes a sixteenth of the samples, but at least 32. CANCELLED: `stop`;
/// RESOURCE_EXHAUSTED: out of memory.
absl::StatusOr<AdaptiveImage> render_adaptively(const Scene& scene, const RenderSettings& settings,
                                                std::uint64_t samples, Pool& pool,
                                                const std::atomic<bool>& stop);

}  // namespace bandsaw::coordinator
