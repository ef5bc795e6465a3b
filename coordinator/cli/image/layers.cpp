// make_layers() renders each layer by an integrator of its own, such as Integrator::kAlbedo. The
// layer of sample counts is not rendered: it has the counts of an adaptive job, or one number for
// all pixels.

#include "coordinator/cli/image/layers.h"

#include <algorithm>
#include <utility>

#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

struct Kind {
  Integrator integrator;  ///< not used for kSamples, which is not rendered
  bool is_number;         ///< the layer has one number for each pixel, no colour
};

/// The layers in the order of LayerKind.
constexpr Kind kKinds[] = {{Integrator::kAlbedo, false},
                           {Integrator::kNormals, false},
                           {Integrator::kDepth, true},
                           {Integrator::kPath, true}};

/// Returns the layer kSamples of an image whose pixels all have `samples` samples.
Image equal_counts(const RenderSettings& settings, std::uint64_t samples) {
  Image image{settings.width, settings.height, {}};
  image.pixels.assign(std::size_t{image.width} * image.height, gray(static_cast<float>(samples)));
  return image;
}

}  // namespace

absl::StatusOr<Layers> make_layers(const std::vector<LayerKind>& kinds, RenderSettings settings,
                                   std::uint64_t samples, const LayerRenderer& render,
                                   const SampleCounts& counts) {
  Layers layers;
  for (const LayerKind wanted : kinds) {
    const Kind& kind = kKinds[static_cast<std::size_t>(wanted)];
    const char* name = kLayerNames[static_cast<std::size_t>(wanted)];
    if (wanted == LayerKind::kSamples) {
      absl::StatusOr<Image> of_pixels = counts ? counts() : equal_counts(settings, samples);
      RETURN_IF_ERROR(of_pixels.status());
      layers.push_back({name, *std::move(of_pixels), kind.is_number});
      continue;
    }
    settings.integrator = kind.integrator;
    ASSIGN_OR_RETURN(Image image, render(settings, std::min(samples, kMaxLayerSamples)));
    layers.push_back({name, std::move(image), kind.is_number});
  }
  return layers;
}

}  // namespace bandsaw::coordinator
