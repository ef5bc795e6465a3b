#include "coordinator/cli/options/layers.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "coordinator/cli/options/choices.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

struct Kind {
  const char* name;
  Integrator integrator;  ///< not used for samples
  bool is_number;
};

/// In the order of LayerKind.
constexpr Kind kKinds[] = {{"albedo", Integrator::kAlbedo, false},
                           {"normal", Integrator::kNormals, false},
                           {"depth", Integrator::kDepth, true},
                           {"samples", Integrator::kPath, true}};

Image equal_counts(const RenderSettings& settings, std::uint64_t samples) {
  Image image{settings.width, settings.height, {}};
  image.pixels.assign(std::size_t{image.width} * image.height, gray(static_cast<float>(samples)));
  return image;
}

}  // namespace

std::vector<std::string> layer_names() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) {
    names.emplace_back(kind.name);
  }
  return names;
}

absl::StatusOr<std::vector<LayerKind>> parse_layers(const std::string& list) {
  std::vector<LayerKind> kinds;
  for (const absl::string_view name : absl::StrSplit(list, ',')) {
    const auto* found = std::find_if(std::begin(kKinds), std::end(kKinds),
                                     [&](const Kind& kind) { return kind.name == name; });
    const auto kind = static_cast<LayerKind>(found - std::begin(kKinds));
    if (found == std::end(kKinds)) {
      return wrong_choice("--layers", std::string(name));
    }
    if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) {
      return absl::InvalidArgumentError(absl::StrCat("--layers: each once, with commas between; '",
                                                     list, "' has ", name, " twice"));
    }
    kinds.push_back(kind);
  }
  return kinds;
}

absl::StatusOr<Layers> make_layers(const std::vector<LayerKind>& kinds, RenderSettings settings,
                                   std::uint64_t samples, const LayerRenderer& render,
                                   const SampleCounts& counts) {
  Layers layers;
  for (const LayerKind wanted : kinds) {
    const Kind& kind = kKinds[static_cast<std::size_t>(wanted)];
    if (wanted == LayerKind::kSamples) {
      absl::StatusOr<Image> of_pixels = counts ? counts() : equal_counts(settings, samples);
      RETURN_IF_ERROR(of_pixels.status());
      layers.push_back({kind.name, *std::move(of_pixels), kind.is_number});
      continue;
    }
    settings.integrator = kind.integrator;
    ASSIGN_OR_RETURN(Image image, render(settings, std::min(samples, kMostLayerSamples)));
    layers.push_back({kind.name, std::move(image), kind.is_number});
  }
  return layers;
}

}  // namespace bandsaw::coordinator
