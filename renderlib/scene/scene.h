#pragma once

// The immutable scene that is rendered. It is the only object of renderlib that rendering threads
// share.

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "renderlib/accel/accel.h"
#include "renderlib/base/pool.h"
#include "renderlib/light/lights.h"
#include "renderlib/medium/grid_medium.h"
#include "renderlib/scene/description.h"
#include "renderlib/scene/medium_spaces.h"
#include "renderlib/scene/scene_features.h"

namespace bandsaw {

struct Kernel;       // renderlib/render/kernel.h
class GuidingCache;  // renderlib/guiding/guiding_cache.h

class Scene;
/// Other scenes, such as those of earlier frames. The BVHs of their meshes may be used again.
using EarlierScenes = absl::Span<const std::shared_ptr<const Scene>>;

/// Made by build() and never changed afterwards.
class Scene {
 public:
  /// Validates the description (scene/validate.h), removes and counts primitives that no ray can
  /// hit, and builds the BVHs and lights. Returns INVALID_ARGUMENT if the description is not valid,
  /// e.g. "spheres[3].radius: must be > 0, is -1". The other parameters change no pixel:
  /// - `forced`: features to enable in addition to those that the scene uses, for tests; this costs
  ///   time.
  /// - `traversal`: how rays find their primitives.
  /// - `kernel`: the code that builds the scene and renders its bands, one of kernels()
  ///   (renderlib/render/kernel.h); nullptr selects the first of them.
  /// - `earlier`: where the description has the same mesh object as one of these scenes, the BVH of
  ///   the mesh is used again.
  static absl::StatusOr<std::shared_ptr<const Scene>> build(SceneDescription description,
                                                            Pool& pool,
                                                            const SceneFeatures& forced = {},
                                                            Traversal traversal = Traversal::kBvh,
                                                            const Kernel* kernel = nullptr,
                                                            const EarlierScenes& earlier = {});

  /// Returns the kernel that built the scene and renders it.
  const Kernel& kernel() const { return *kernel_; }
  const Geometry& geometry() const { return description_.geometry; }
  const Accel& accel() const { return *accel_; }
  const Lights& lights() const { return lights_; }
  const Media& media() const { return description_.media; }
  /// Returns the BVHs of the boundaries of media, which accel() does not contain. features().media
  /// MUST be set.
  const Accel& boundary_accel() const { return *boundary_accel_; }
  /// Returns the medium prepared for tracking if it varies in space, otherwise nullptr.
  /// features().grids MUST be set.
  const GridMedium* grid_medium(MediumId id) const {
    const std::optional<GridMedium>& medium = grid_media_[index_of(id)];
    return medium ? &*medium : nullptr;
  }
  /// Returns the map from the world to the space of the medium in a boundary at this time.
  /// `boundary` is Hit::id.instance of boundary_accel() (scene/medium_spaces.h). features().grids
  /// MUST be set.
  Transform to_medium(std::uint32_t boundary, double time) const {
    return medium_spaces_.to_medium(description_.media.boundaries, boundary, time);
  }
  const Background& background() const { return description_.background; }
  const Camera& camera() const { return description_.camera; }
  /// Returns the camera when the shutter closes; std::nullopt if it does not move.
  const std::optional<Camera>& camera_at_close() const { return description_.camera_at_close; }
  const PixelFilter& filter() const { return description_.filter; }
  const LocalShading& local_shading() const { return description_.local_shading; }
  const Material& material(MaterialId id) const { return description_.materials[index_of(id)]; }
  const std::vector<Material>& materials() const { return description_.materials; }
  const Texture& texture(TextureId id) const { return description_.textures[index_of(id)]; }
  const std::vector<Texture>& textures() const { return description_.textures; }
  /// Returns the features that the scene uses, and those that were forced.
  const SceneFeatures& features() const { return features_; }
  /// Returns true if an instance, a mesh or a boundary of a medium moves during the shutter
  /// interval. A camera that moves alone does not count. Forced features do not change it.
  bool moves() const { return moves_; }
  /// Returns true if neighbouring pixels reuse each other's path vertices
  /// (integrate/path_reuse.h). Forced features do not change it.
  bool reuses_paths() const { return reuses_paths_; }
  /// Returns the number of primitives that were removed because no ray can hit them.
  std::size_t dropped_primitives() const { return dropped_; }
  /// Returns the cache of the fields of path guiding and of photon maps. Each field or map is a
  /// pure function of the scene and a key, and is made when it is first used. Thread-safe.
  GuidingCache& guiding() const { return *guiding_; }

  ~Scene();

 private:
  friend struct Kernel;  // refers to `build_with`, which is compiled for each kernel

  /// The part of `build` that is compiled for each kernel; `kernel` is the chosen one.
  static absl::StatusOr<std::shared_ptr<const Scene>> build_with(
      const Kernel& kernel, SceneDescription description, Pool& pool, const SceneFeatures& forced,
      Traversal traversal, const EarlierScenes& earlier);

  Scene(const Kernel& kernel, SceneDescription description);
  /// Offers the meshes of this scene to a new scene that is built with `kernel`. Adds each mesh to
  /// `clean`, with the number of triangles that it lost, and adds the BVHs that contain the meshes
  /// to `accels`. Adds nothing if this scene has another kernel or was not built with
  /// Traversal::kBvh.
  void add_meshes_to(const Kernel& kernel, std::map<const Mesh*, std::size_t>& clean,
                     std::vector<const Accel*>& accels) const;
  const Kernel* kernel_;
  SceneDescription description_;
  std::unique_ptr<Accel> accel_;
  std::unique_ptr<Accel> boundary_accel_;
  std::vector<std::optional<GridMedium>> grid_media_;
  MediumSpaces medium_spaces_;
  Lights lights_;
  SceneFeatures features_;
  bool moves_ = false;
  bool reuses_paths_ = false;
  std::size_t dropped_ = 0;
  std::vector<std::size_t> dropped_of_mesh_;  ///< number of triangles that each mesh lost
  Traversal traversal_ = Traversal::kBvh;
  std::unique_ptr<GuidingCache> guiding_;
};

}  // namespace bandsaw
