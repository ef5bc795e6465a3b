#pragma once

// A kernel: the code that builds scenes and renders them, compiled for one instruction set. A
// program holds one kernel or two (renderlib/README.md, "Kernels"), and a scene uses one of them.
// All kernels give the same bits.

#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/denoise/fit.h"
#include "renderlib/render/hash64.h"
#include "renderlib/render/render_band.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// The functions of a kernel. Scene::build (scene/scene.h) and render_band (render_band.h) call
/// them and describe their parameters.
struct Kernel {
  /// "avx2", "neon", "wasm" or "plain".
  const char* name;
  absl::StatusOr<std::shared_ptr<const Scene>> (*build)(const Kernel& kernel,
                                                        SceneDescription description, Pool& pool,
                                                        const SceneFeatures& forced,
                                                        Traversal traversal,
                                                        const EarlierScenes& earlier);
  absl::StatusOr<BandPixels> (*render_band)(const Scene& scene, const RenderSettings& settings,
                                            const Band& band, Pool& pool,
                                            const std::atomic<bool>& stop, const RowsDone& progress,
                                            const TileSamples& tiles);
  /// The denoiser's fit() (denoise/fit.h).
  FitFunction fit;
  /// Adds values of all functions of renderlib/math/elementary.h to the hash. Kernels and machines
  /// are compared by such a hash.
  void (*add_elementary_functions)(Hash64& hash);

  /// Compiled like the rest of the program, for every machine that the program runs on.
  static const Kernel kBase;
  /// Compiled for x86-64-v3. It exists only in programs that must run on every x86-64 processor.
  /// merge_kernel.sh hides all symbols of this kernel except this one.
  static const Kernel kAvx2;
};

/// Returns the kernels of this program that this machine can run, fastest first; at least one.
std::vector<const Kernel*> kernels();

/// Returns the kernel of kernels() with this name. If there is none, returns INVALID_ARGUMENT with
/// the names of all kernels().
absl::StatusOr<const Kernel*> find_kernel(absl::string_view name);

}  // namespace bandsaw
