#include "renderlib/scene/sharing.h"

#include <algorithm>

#include "renderlib/material/interiors.h"
#include "renderlib/material/opacity.h"

namespace bandsaw {
namespace {

/// Returns true if the material fully occludes what is behind it, for shadow rays and for paths
/// alike.
bool is_opaque(const Material& material) {
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

}  // namespace

bool shares_paths(const SceneDescription& scene, const Lights& lights, const Needs& needs) {
  const Background& background = scene.background;
  if (lights.empty() || background.environment || !is_black(background.bottom) ||
      !is_black(background.top) || needs.media || needs.motion) {
    return false;
  }
  const Geometry& geometry = scene.geometry;
  const auto opaque = [&](MaterialId id) {
    return id == kOwnMaterial || is_opaque(scene.materials[index_of(id)]);
  };
  return all_of_shapes(geometry, opaque) &&
         std::all_of(geometry.groups.begin(), geometry.groups.end(),
                     [&](const Shapes& group) { return all_of_shapes(group, opaque); }) &&
         std::all_of(geometry.instances.begin(), geometry.instances.end(),
                     [&](const Instance& instance) { return opaque(instance.material); });
}

}  // namespace bandsaw
