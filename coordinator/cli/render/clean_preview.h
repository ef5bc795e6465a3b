#pragma once

// Clean previews of an image that is being rendered: reduced in size. The denoiser's guides (images
// of albedo and shape) have only few samples.

#include <atomic>
#include <cstdint>
#include <optional>

#include "absl/status/statusor.h"
#include "renderlib/base/pool.h"
#include "renderlib/image/image.h"
#include "renderlib/render/film.h"
#include "renderlib/render/settings.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {

/// Used by one thread at a time. The references MUST outlive it.
class CleanPreview {
 public:
  /// Samples of the guides; with more of them the preview would cost as much as the image.
  static constexpr std::uint64_t kGuideSamples = 4;

  CleanPreview(const Scene& scene, const RenderSettings& settings, Pool& pool,
               const std::atomic<bool>& stop)
      : scene_(scene), settings_(settings), pool_(pool), stop_(stop) {}

  /// Returns the clean image of the samples that are present, with at most about `most_side` pixels
  /// a side; std::nullopt until every pixel has two blocks of samples. The first call renders the
  /// guides. Errors as render_image.
  absl::StatusOr<std::optional<Image>> of(const Film& film, std::uint32_t most_side);

 private:
  absl::StatusOr<Image> guide(Integrator integrator, std::uint32_t step);

  const Scene& scene_;
  const RenderSettings& settings_;
  Pool& pool_;
  const std::atomic<bool>& stop_;
  struct Guides {
    Image albedo;
    Image shape;
  };
  std::optional<Guides> guides_;  ///< reduced
};

}  // namespace bandsaw::coordinator
