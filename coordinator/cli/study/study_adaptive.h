#pragma once

// An adaptive image of about so many samples a pixel: what `--error E --adaptive` does, for a study
// that counts samples.

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
  double samples = 0;  ///< a pixel, on average: as many as were asked for, or a few more
  double rays = 0;
};

/// The pilot has a sixteenth of the samples, but not fewer than 32. CANCELLED; RESOURCE_EXHAUSTED:
/// no memory.
absl::StatusOr<AdaptiveImage> render_adaptively(const Scene& scene, const RenderSettings& settings,
                                                std::uint64_t samples, Pool& pool,
                                                const std::atomic<bool>& stop);

}  // namespace bandsaw::coordinator
