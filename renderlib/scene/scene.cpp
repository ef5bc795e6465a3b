// build_with() removes primitives that no ray can hit, makes instances static if they do not move
// while the shutter is open, builds BVHs and lights, and finds the features that the scene uses.

#include "renderlib/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "renderlib/base/status_macros.h"
#include "renderlib/geometry/deforming_mesh.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/material/interiors.h"
#include "renderlib/material/opacity.h"
#include "renderlib/material/plastic_coat.h"
#include "renderlib/scene/static_instances.h"
#include "renderlib/scene/validate.h"

namespace bandsaw {
namespace {

/// Returns true if the parallelogram of these edges has a finite area > 0.
bool has_area(const Vec3& u, const Vec3& v) {
  // Scaled, so that the area of tiny shapes does not underflow.
  const double size = std::max(max_abs(u), max_abs(v));
  if (!(size > 0) || !std::isfinite(size)) {
    return false;
  }
  const Vec3 normal = cross(u / size, v / size);
  return is_finite(normal) && max_abs(normal) > 0;
}

template <std::size_t N>
bool all_finite(const std::array<float, N>& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

template <std::size_t N>
void zero_if_not_finite(std::vector<std::array<float, N>>& list) {
  for (std::array<float, N>& values : list) {
    if (!all_finite(values)) {
      values.fill(0);
    }
  }
}

/// Returns true if a triangle of a mesh that deforms may be hit at some time. This holds if its
/// corners and their movements are finite, and if no two corners are equal both when the shutter
/// opens and when it closes.
bool may_be_hit(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<float, 3>& open = mesh.positions[triangle[i]];
    const std::array<float, 3>& close = mesh.positions_at_close[triangle[i]];
    const std::uint32_t next = triangle[(i + 1) % 3];
    if (open == mesh.positions[next] && close == mesh.positions_at_close[next]) {
      return false;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (!std::isfinite(open[k]) || !std::isfinite(close[k]) ||
          !std::isfinite(close[k] - open[k])) {
        return false;
      }
    }
  }
  return true;
}

/// Removes the triangles of the mesh that no ray can hit, and returns their number.
std::size_t clean_mesh(Mesh& mesh) {
  zero_if_not_finite(mesh.normals);
  zero_if_not_finite(mesh.normals_at_close);
  zero_if_not_finite(mesh.uvs);
  zero_if_not_finite(mesh.uvs2);
  zero_if_not_finite(mesh.colors);
  if (deforms(mesh)) {
    return std::erase_if(mesh.triangles,
                         [&](const auto& triangle) { return !may_be_hit(mesh, triangle); });
  }
  return std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<float, 3>& p = mesh.positions[triangle[i]];
      corners[i] = {p[0], p[1], p[2]};
    }
    return !has_area(corners[1] - corners[0], corners[2] - corners[0]);
  });
}

std::size_t clean_shapes(Shapes& shapes) {
  return std::erase_if(shapes.quads, [](const Quad& q) { return !has_area(q.u, q.v); }) +
         std::erase_if(shapes.triangles,
                       [](const Triangle& t) { return !has_area(t.b - t.a, t.c - t.a); });
}

/// The meshes that were cleaned when an earlier scene was built. The second entry is the number of
/// triangles that the mesh lost.
using CleanMeshes = std::map<const Mesh*, std::size_t>;

/// Removes quads and triangles whose area is zero or not finite (e.g. because a vertex is not
/// finite), also from meshes and groups. The other primitives keep their order. Normals, uvs and
/// colours that are not finite become zero. The meshes in `known` are clean already. Returns the
/// number of removed primitives; a primitive of a mesh or group counts once per instance. Appends
/// to `dropped_of_mesh` the number of triangles that each mesh lost.
std::size_t clean(Geometry& geometry, const CleanMeshes& known,
                  std::vector<std::size_t>& dropped_of_mesh) {
  std::size_t dropped = clean_shapes(geometry);
  std::vector<std::size_t> dropped_of_group;
  for (Shapes& group : geometry.groups) {
    dropped_of_group.push_back(clean_shapes(group));
  }
  for (std::size_t mesh = 0; mesh < geometry.meshes.size(); ++mesh) {
    const auto found = known.find(&geometry.meshes[mesh]);
    dropped_of_mesh.push_back(found != known.end() ? found->second
                                                   : clean_mesh(geometry.meshes.change(mesh)));
  }
  for (const Instance& instance : geometry.instances) {
    dropped += instance.group == kNoGroup ? dropped_of_mesh[index_of(instance.mesh)]
                                          : dropped_of_group[index_of(instance.group)];
  }
  return dropped;
}

bool has_grids(const Media& media) {
  return std::any_of(media.media.begin(), media.media.end(),
                     [](const Medium& medium) { return medium.grids.any(); });
}

/// Returns the media that vary in space, prepared for tracking; one entry for each medium.
std::vector<std::optional<GridMedium>> grid_media_of(const Media& media) {
  std::vector<std::optional<GridMedium>> result(media.media.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (media.media[i].grids.any()) {
      result[i].emplace(media.media[i], media.grids);
    }
  }
  return result;
}

/// Returns true if an instance, a mesh or a boundary of a medium moves.
bool anything_moves(const SceneDescription& scene) {
  return moves(scene.geometry) || moves(scene.media.boundaries);
}

SceneFeatures features_of(const SceneDescription& scene, const Lights& lights) {
  SceneFeatures features;
  features.lights = !lights.empty();
  features.alpha = std::any_of(scene.materials.begin(), scene.materials.end(), has_alpha);
  features.motion = scene.camera_at_close.has_value() || anything_moves(scene);
  features.uv = std::any_of(scene.textures.begin(), scene.textures.end(), uses_uv);
  features.mixtures = std::any_of(
      scene.materials.begin(), scene.materials.end(),
      [](const Material& material) { return std::holds_alternative<Mix>(material.kind); });
  features.media = scene.media.fog || scene.media.has_boundaries();
  features.grids = features.media && has_grids(scene.media);
  return features;
}

/// Returns true if the material fully occludes what is behind it, for shadow rays and for paths
/// alike.
bool is_opaque(const std::vector<Material>& materials, MaterialId id) {
  const Material& material = materials[index_of(id)];
  if (const auto* mix = std::get_if<Mix>(&material.kind)) {
    return is_opaque(materials, mix->a) && is_opaque(materials, mix->b);
  }
  return !has_alpha(material) && nested_glass(material) == nullptr;
}

template <class OfMaterial>
bool all_of_shapes(const Shapes& shapes, const OfMaterial& test) {
  const auto all = [&](const auto& kind) {
    return std::all_of(kind.begin(), kind.end(),
                       [&](const auto& shape) { return test(shape.material); });
  };
  return all(shapes.spheres) && all(shapes.quads) && all(shapes.triangles) && all(shapes.disks);
}

/// Returns true if neighbouring pixels can reuse each other's path vertices. This needs lights, a
/// black background, no motion and no media. Every surface must be opaque for paths and shadow rays
/// alike. `features` are the features that the scene uses.
bool can_reuse_paths(const SceneDescription& scene, const Lights& lights,
                     const SceneFeatures& features) {
  if (lights.empty() || !is_black(scene.background) || features.media || features.motion) {
    return false;
  }
  const Geometry& geometry = scene.geometry;
  const auto opaque = [&](MaterialId id) {
    return id == kOwnMaterial || is_opaque(scene.materials, id);
  };
  return all_of_shapes(geometry, opaque) &&
         std::all_of(geometry.groups.begin(), geometry.groups.end(),
                     [&](const Shapes& group) { return all_of_shapes(group, opaque); }) &&
         std::all_of(geometry.instances.begin(), geometry.instances.end(),
                     [&](const Instance& instance) { return opaque(instance.material); });
}

}  // namespace

Scene::Scene(const Kernel& kernel, SceneDescription description)
    : kernel_(&kernel),
      description_(std::move(description)),
      guiding_(std::make_unique<GuidingCache>()) {}

Scene::~Scene() = default;

void Scene::add_meshes_to(const Kernel& kernel, std::map<const Mesh*, std::size_t>& clean,
                          std::vector<const Accel*>& accels) const {
  if (&kernel != kernel_ || traversal_ != Traversal::kBvh) {
    return;
  }
  for (std::size_t mesh = 0; mesh < geometry().meshes.size(); ++mesh) {
    clean.emplace(&geometry().meshes[mesh], dropped_of_mesh_[mesh]);
  }
  accels.push_back(accel_.get());
  if (boundary_accel_ != nullptr) {
    accels.push_back(boundary_accel_.get());
  }
}

absl::StatusOr<std::shared_ptr<const Scene>> Scene::build_with(
    const Kernel& kernel, SceneDescription description, Pool& pool, const SceneFeatures& forced,
    Traversal traversal, const EarlierScenes& earlier) {
  CleanMeshes known;
  std::vector<const Accel*> accels;
  for (const std::shared_ptr<const Scene>& other : earlier) {
    other->add_meshes_to(kernel, known, accels);
  }
  RETURN_IF_ERROR(validate(description, MeshVertices::kAny,
                           [&](const Mesh& mesh) { return known.find(&mesh) != known.end(); }));
  // BVHs and lights hold pointers into the scene, so the scene gets its final place in memory
  // first.
  std::shared_ptr<Scene> scene(new Scene(kernel, std::move(description)));
  SceneDescription& own = scene->description_;
  scene->dropped_ = clean(own.geometry, known, scene->dropped_of_mesh_);
  scene->traversal_ = traversal;
  const Shutter& shutter = shutter_of(own.camera);
  own.geometry.shutter = {shutter.open, shutter.close};
  own.media.boundaries.shutter = own.geometry.shutter;
  make_static(own.geometry);
  // A medium fills its boundary, a closed shape. The boundary may lie in a frame, a coordinate
  // system that may move. If the medium varies in space, it varies in the coordinates of this
  // frame. MediumSpaces stores the frames before make_static() removes those of static boundaries.
  if (has_grids(own.media)) {
    scene->medium_spaces_ = MediumSpaces(own.media.boundaries);
  }
  make_static(own.media.boundaries);
  prepare_surfaces(own.geometry);
  prepare_materials(absl::MakeSpan(own.materials));
  scene->accel_ = std::make_unique<Accel>(Accel::build(own.geometry, pool, traversal, accels));
  scene->lights_ = Lights(own.geometry, own.materials, own.textures, own.lights, own.background);
  const SceneFeatures features = features_of(own, scene->lights_);
  scene->moves_ = anything_moves(own);
  scene->reuses_paths_ = can_reuse_paths(own, scene->lights_, features);
  scene->features_ = features | forced;
  if (scene->features_.grids) {
    scene->grid_media_ = grid_media_of(own.media);
    scene->medium_spaces_.prepare(own.media.boundaries, shutter.open);
  }
  if (scene->features_.media) {
    scene->boundary_accel_ =
        std::make_unique<Accel>(Accel::build(own.media.boundaries, pool, traversal, accels));
  }
  return std::shared_ptr<const Scene>(std::move(scene));
}

}  // namespace bandsaw
