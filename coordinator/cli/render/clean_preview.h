#pragma once

// Makes denoised previews of an image that is being rendered, for `render --denoise --preview`. The
// previews are reduced in size, and the denoiser's guides (images of the albedo and the shape of
// the surfaces) have few samples, so that a preview takes little time.

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

/// Makes the previews of one image. Used by one thread at a time. The arguments of the constructor
/// MUST outlive the object.
class CleanPreview {
 public:
  CleanPreview(const Scene& scene, const RenderSettings& settings, Pool& pool,
               const std::atomic<bool>& stop)
      : scene_(scene), settings_(settings), pool_(pool), stop_(stop) {}

  /// Returns the image of the samples in `film`, without noise and reduced to at most `most_side`
  /// pixels a side. Returns std::nullopt until every pixel has more than one block of 8 samples.
  /// The first call renders the guides. `most_side` MUST be above 0 and the same in all calls.
  /// Errors: those of render_image().
  absl::StatusOr<std::optional<Image>> of(const Film& film, std::uint32_t most_side);

 private:
  /// Renders a guide and reduces it: `step` by `step` pixels become one.
  absl::StatusOr<Image> guide(Integrator integrator, std::uint32_t step);

  const Scene& scene_;
  const RenderSettings& settings_;
  Pool& pool_;
  const std::atomic<bool>& stop_;
  struct Guides {
    Image albedo;
    Image shape;
  };
  std::optional<Guides> guides_;  ///< reduced; std::nullopt: not rendered yet
};

}  // namespace bandsaw::coordinator
