// The constructor makes one part for the loose shapes (of no instance) and one for each instance,
// unless the part would have no wanted primitive. operator[] finds the part by bisection.

#include "renderlib/geometry/primitive_list.h"

#include <algorithm>

#include "renderlib/geometry/placement.h"

namespace bandsaw {
namespace {

/// Returns the numbers of the shapes whose material is wanted, ascending.
std::vector<std::uint32_t> chosen_of(const Shapes& shapes, const std::vector<bool>& wanted) {
  std::vector<std::uint32_t> chosen;
  for (std::size_t primitive = 0; primitive < shapes.size(); ++primitive) {
    if (wanted[index_of(material_of(shapes, primitive))]) {
      chosen.push_back(static_cast<std::uint32_t>(primitive));
    }
  }
  return chosen;
}

}  // namespace

PrimitiveList::PrimitiveList(const Geometry& geometry, const std::vector<bool>& wanted) {
  const auto add_chosen = [&](std::uint32_t instance, GroupId group, const Shapes& shapes) {
    auto of_group = chosen_.find(group);
    if (of_group == chosen_.end()) {
      of_group = chosen_.emplace(group, chosen_of(shapes, wanted)).first;
    }
    add(instance, &of_group->second, of_group->second.size());
  };
  add_chosen(0, kNoGroup, geometry);
  for (std::uint32_t i = 0; i < geometry.instances.size(); ++i) {
    const Instance& placed = geometry.instances[i];
    if (placed.group != kNoGroup && placed.material == kOwnMaterial) {
      add_chosen(i + 1, placed.group, *group_of(geometry, placed));
    } else if (wanted[index_of(placed.material)]) {
      add(i + 1, nullptr, primitives_of(geometry, placed));
    }
  }
}

void PrimitiveList::add(std::uint32_t instance, const std::vector<std::uint32_t>* chosen,
                        std::uint64_t primitives) {
  if (primitives > 0) {
    parts_.push_back({instance, chosen, size() + primitives});
  }
}

PrimitiveId PrimitiveList::operator[](std::uint64_t i) const {
  const auto part =
      std::upper_bound(parts_.begin(), parts_.end(), i,
                       [](std::uint64_t number, const Part& of) { return number < of.up_to; });
  const std::uint64_t before = part == parts_.begin() ? 0 : (part - 1)->up_to;
  const auto within = static_cast<std::size_t>(i - before);
  return {part->instance,
          part->chosen == nullptr ? static_cast<std::uint32_t>(within) : (*part->chosen)[within]};
}

}  // namespace bandsaw
