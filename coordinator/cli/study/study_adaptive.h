#pragma once

// Renders an adaptive image for `bandsaw study`. It takes samples as a job with `--error E
// --adaptive` does, but stops at a mean number of samples per pixel instead of an error.

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
  double rays = 0;  ///< number of all rays
};

/// Renders with `samples` per pixel on average. First renders a pilot, in which every pixel gets
/// the same number of samples: a sixteenth of `samples`, rounded down to whole blocks of 8 samples,
/// but at least 32 and at most `samples`. CANCELLED: `stop` was set. RESOURCE_EXHAUSTED: out of
/// memory.
absl::StatusOr<AdaptiveImage> render_adaptively(const Scene& scene, const RenderSettings& settings,
                                                std::uint64_t samples, Pool& pool,
                                                const std::atomic<bool>& stop);

}  // namespace bandsaw::coordinator
