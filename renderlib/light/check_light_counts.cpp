// Counts the primitives to which the class Lights would give numbers: all shapes that are not in an
// instance, and all primitives of each instance that emits light anywhere.

#include "renderlib/light/check_light_counts.h"

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/geometry/placement.h"
#include "renderlib/light/emission.h"

namespace bandsaw {
namespace {

/// For each material, true if it emits light.
using Emits = std::vector<bool>;

/// Returns for each group whether any of its shapes emits light by its own material.
std::vector<bool> emitting_groups(const Geometry& geometry, const Emits& emits) {
  std::vector<bool> groups;
  for (const Shapes& group : geometry.groups) {
    bool any = false;
    for (std::size_t shape = 0; shape < group.size() && !any; ++shape) {
      any = emits[index_of(material_of(group, shape))];
    }
    groups.push_back(any);
  }
  return groups;
}

/// Returns the number of primitives to which `Lights` gives numbers.
std::uint64_t numbered(const Geometry& geometry, const Emits& emits) {
  const std::vector<bool> groups = emitting_groups(geometry, emits);
  std::uint64_t count = geometry.size();
  for (const Instance& instance : geometry.instances) {
    const bool own = instance.group != kNoGroup && instance.material == kOwnMaterial;
    const bool any = own ? groups[index_of(instance.group)] : emits[index_of(instance.material)];
    count += any ? primitives_of(geometry, instance) : 0;
  }
  return count;
}

}  // namespace

absl::Status check_light_counts(const Geometry& geometry, absl::Span<const Material> materials,
                                absl::Span<const Texture> textures, std::uint64_t delta_lights) {
  Emits emits;
  const auto id = [](std::size_t i) { return MaterialId{static_cast<std::uint32_t>(i)}; };
  for (std::size_t i = 0; i < materials.size(); ++i) {
    emits.push_back(bandsaw::emits(materials, id(i)));
  }
  if (numbered(geometry, emits) + delta_lights <= kMaxLights) {
    return absl::OkStatus();
  }
  // An emission whose texture is black everywhere does not count. The textures take long to
  // examine, so they are examined only if the first count is too large.
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto mean_of = [&](TextureId texture) { return mean(textures, texture); };
    emits[i] = emits[i] && !is_black(mean_emission(materials, id(i), mean_of).radiance);
  }
  const std::uint64_t count = numbered(geometry, emits) + delta_lights;
  if (count <= kMaxLights) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(absl::StrCat(
      "lights: there are ", count,
      " primitives (all shapes outside of instances, all primitives of instances that emit light, "
      "and all lights without size), and at most ",
      kMaxLights,
      " are possible: use fewer instances that emit light, or fewer primitives in them"));
}

}  // namespace bandsaw
