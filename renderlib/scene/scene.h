#pragma once

// The immutable scene that is rendered. Shared by the threads that render it; the only object of
// renderlib that is.

#include <memory>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/accel/accel.h"
#include "renderlib/base/pool.h"
#include "renderlib/light/lights.h"
#include "renderlib/scene/description.h"
#include "renderlib/scene/needs.h"

namespace bandsaw {

struct Kernel;  // renderlib/render/kernel.h

class Scene {
 public:
  /// Checks the description (indices, ranges, finiteness), drops what cannot be hit or cannot shine
  /// (degenerate triangles, triangles with non-finite vertices) and counts it, and builds the trees
  /// and lights. INVALID_ARGUMENT: "spheres[3].radius: must be > 0, is -1".
  /// `forced`: needs that it is to have beside its own; costs time and changes no pixel. For tests.
  /// `traversal`: the same, for comparison.
  /// `kernel`: the code that builds the scene and renders its bands; it changes no pixel. One of
  /// kernels() (renderlib/render/kernel.h); null: the first of them.
  static absl::StatusOr<std::shared_ptr<const Scene>> build(SceneDescription description,
                                                            Pool& pool, const Needs& forced = {},
                                                            Traversal traversal = Traversal::kBvh,
                                                            const Kernel* kernel = nullptr);

  /// The kernel that built it and renders it.
  const Kernel& kernel() const { return *kernel_; }
  const Geometry& geometry() const { return description_.geometry; }
  const Accel& accel() const { return *accel_; }
  const Lights& lights() const { return lights_; }
  const Media& media() const { return description_.media; }
  /// Of the media's boundaries, which the scene's own trees do not hold. MUST NOT be asked without
  /// needs().media.
  const Accel& boundary_accel() const { return *boundary_accel_; }
  const Background& background() const { return description_.background; }
  const Camera& camera() const { return description_.camera; }
  const PixelFilter& filter() const { return description_.filter; }
  const LocalShading& local_shading() const { return description_.local_shading; }
  const Material& material(MaterialId id) const { return description_.materials[index_of(id)]; }
  const Texture& texture(TextureId id) const { return description_.textures[index_of(id)]; }
  const std::vector<Texture>& textures() const { return description_.textures; }
  const Needs& needs() const { return needs_; }
  /// Whether pixels share what their paths find (sharing.h). A property of what the scene holds:
  /// forced needs do not change it.
  bool shares_paths() const { return shares_paths_; }
  /// Primitives that were left out because no ray can hit them.
  std::size_t dropped_primitives() const { return dropped_; }

 private:
  friend struct Kernel;  // it holds `build_with`, compiled for its instruction set

  /// What `build` does in the kernel that it chose, which is `kernel`.
  static absl::StatusOr<std::shared_ptr<const Scene>> build_with(const Kernel& kernel,
                                                                 SceneDescription description,
                                                                 Pool& pool, const Needs& forced,
                                                                 Traversal traversal);

  Scene(const Kernel& kernel, SceneDescription description)
      : kernel_(&kernel), description_(std::move(description)) {}
  const Kernel* kernel_;
  SceneDescription description_;
  std::unique_ptr<Accel> accel_;
  std::unique_ptr<Accel> boundary_accel_;
  Lights lights_;
  Needs needs_;
  bool shares_paths_ = false;
  std::size_t dropped_ = 0;
};

}  // namespace bandsaw
