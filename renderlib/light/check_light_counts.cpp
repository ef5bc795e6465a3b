#include "renderlib/light/check_light_counts.h"

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/geometry/placement.h"
#include "renderlib/light/emission.h"

namespace bandsaw {
namespace {

/// Of each material.
using Shines = std::vector<bool>;

/// Of each group, whether any of its shapes shines by its own material.
std::vector<bool> shining_groups(const Geometry& geometry, const Shines& shines) {
  std::vector<bool> groups;
  for (const Shapes& group : geometry.groups) {
    bool any = false;
    for (std::size_t shape = 0; shape < group.size() && !any; ++shape) {
      any = shines[index_of(material_of(group, shape))];
    }
    groups.push_back(any);
  }
  return groups;
}

/// How many primitives Lights gives numbers to.
std::uint64_t numbered(const Geometry& geometry, const Shines& shines) {
  const std::vector<bool> groups = shining_groups(geometry, shines);
  std::uint64_t count = geometry.size();
  for (const Instance& instance : geometry.instances) {
    const bool own = instance.group != kNoGroup && instance.material == kOwnMaterial;
    const bool any = own ? groups[index_of(instance.group)] : shines[index_of(instance.material)];
    count += any ? primitives_of(geometry, instance) : 0;
  }
  return count;
}

}  // namespace

absl::Status check_light_counts(const Geometry& geometry, absl::Span<const Material> materials,
                                absl::Span<const Texture> textures, std::uint64_t without_size) {
  Shines shines;
  for (const Material& material : materials) {
    shines.push_back(emission_of(material).has_value());
  }
  if (numbered(geometry, shines) + without_size <= kMaxLights) {
    return absl::OkStatus();
  }
  // Textures that are black all over are looked at only where that matters: it takes long.
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (const auto emission = emission_of(materials[i])) {
      const Tint& radiance = emission->radiance;
      shines[i] = !is_black(mean(textures, radiance.texture) * radiance.factor);
    }
  }
  const std::uint64_t count = numbered(geometry, shines) + without_size;
  if (count <= kMaxLights) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat("lights: instances that emit light, loose shapes and lights without size are ",
                   count, " primitives in all, at most ", kMaxLights,
                   " are possible: place what emits light fewer times, or with fewer primitives"));
}

}  // namespace bandsaw
