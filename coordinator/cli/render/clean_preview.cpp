// of() reduces the image to the size of the preview and denoises it. The denoiser's guides (images
// of the albedo and the shape of the surfaces) are rendered at the first call and reduced in the
// same way.

#include "coordinator/cli/render/clean_preview.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "renderlib/base/status_macros.h"
#include "renderlib/denoise/denoise.h"
#include "renderlib/image/shrink.h"
#include "renderlib/render/kernel.h"
#include "renderlib/render/render_image.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw::coordinator {

absl::StatusOr<Image> CleanPreview::guide(Integrator integrator, std::uint32_t step) {
  RenderSettings settings = settings_;
  settings.integrator = integrator;
  ASSIGN_OR_RETURN(const RenderedImage rendered,
                   render_image(scene_, settings, kGuideSamples, pool_, stop_, /*progress=*/{},
                                /*spill_folder=*/""));
  return shrunk(rendered.film.snapshot().image, step, step);
}

absl::StatusOr<std::optional<Image>> CleanPreview::of(const Film& film, std::uint32_t most_side) {
  const std::optional<Film::FirstPart> first = film.first_part();
  if (!first) {
    return std::nullopt;
  }
  const std::uint32_t step = (std::max(film.width(), film.height()) - 1) / most_side + 1;
  if (!guides_) {
    ASSIGN_OR_RETURN(Image albedo, guide(kGuideAlbedo, step));
    ASSIGN_OR_RETURN(Image shape, guide(kGuideShape, step));
    guides_ = Guides{std::move(albedo), std::move(shape)};
  }
  DenoiseInput input{.mean = shrunk(film.snapshot().image, step, step),
                     .first = shrunk(first->mean, step, step),
                     .first_share = {},
                     .albedo = guides_->albedo,
                     .shape = guides_->shape};
  // `first->mean` is the mean of about half of each pixel's samples. `first->share` is the exact
  // fraction of the pixel's samples in this mean. The fraction differs little among the pixels that
  // are reduced to one pixel, so the fraction of the top left pixel is used.
  for (std::uint32_t y = 0; y < input.mean.height; ++y) {
    for (std::uint32_t x = 0; x < input.mean.width; ++x) {
      input.first_share.push_back(first->share[std::size_t{y} * step * film.width() + x * step]);
    }
  }
  return denoise(input, scene_.kernel().fit, pool_).image;
}

}  // namespace bandsaw::coordinator
