// A kernel is the render code, compiled for one instruction set. This file selects the kernel, and
// calls it for Scene::build() and render_band(). The file itself is compiled for the oldest
// processor that the program runs on.

#include "renderlib/render/kernel.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "renderlib/base/x86_64_v3.h"

namespace bandsaw {

std::vector<const Kernel*> kernels() {
#if defined(BANDSAW_HAS_AVX2_KERNEL)
  if (runs_x86_64_v3()) {
    return {&Kernel::kAvx2, &Kernel::kBase};
  }
#endif
  return {&Kernel::kBase};
}

absl::StatusOr<const Kernel*> find_kernel(absl::string_view name) {
  const std::vector<const Kernel*> found = kernels();
  for (const Kernel* kernel : found) {
    if (kernel->name == name) {
      return kernel;
    }
  }
  const auto add_name = [](std::string* out, const Kernel* kernel) { *out += kernel->name; };
  return absl::InvalidArgumentError(absl::StrCat("this program on this machine has no kernel '",
                                                 name, "'; it has ",
                                                 absl::StrJoin(found, " and ", add_name)));
}

absl::StatusOr<std::shared_ptr<const Scene>> Scene::build(SceneDescription description, Pool& pool,
                                                          const SceneFeatures& forced,
                                                          Traversal traversal, const Kernel* kernel,
                                                          const EarlierScenes& earlier) {
  const Kernel& chosen = kernel != nullptr ? *kernel : *kernels().front();
  return chosen.build(chosen, std::move(description), pool, forced, traversal, earlier);
}

absl::StatusOr<BandPixels> render_band(const Scene& scene, const RenderSettings& settings,
                                       const Band& band, Pool& pool, const std::atomic<bool>& stop,
                                       const RowsDone& progress, const TileSamples& tiles) {
  return scene.kernel().render_band(scene, settings, band, pool, stop, progress, tiles);
}

}  // namespace bandsaw
