#pragma once

// Lists the primitives of a geometry by their material.

#include <cstdint>
#include <map>
#include <vector>

#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// The primitives whose material belongs to a set, in the order of their ids: first the loose
/// shapes (of no instance), then the primitives of each instance. The instances of a group share
/// the list of the group's primitives. So time and memory grow with the number of instances plus
/// the number of stored primitives, and not with the product of these two numbers.
class PrimitiveList {
 public:
  /// `wanted`: for each material, whether its primitives belong to the list.
  PrimitiveList(const Geometry& geometry, const std::vector<bool>& wanted);
  PrimitiveList(const PrimitiveList&) = delete;
  PrimitiveList& operator=(const PrimitiveList&) = delete;

  std::uint64_t size() const { return parts_.empty() ? 0 : parts_.back().up_to; }
  /// `i` MUST be below size().
  PrimitiveId operator[](std::uint64_t i) const;

 private:
  /// The primitives of an instance, or the loose shapes.
  struct Part {
    std::uint32_t instance = 0;                          ///< PrimitiveId::instance
    const std::vector<std::uint32_t>* chosen = nullptr;  ///< their numbers; null: all
    std::uint64_t up_to = 0;  ///< number of primitives of this part and all parts before it
  };
  /// Adds a part with `primitives` primitives, or nothing if `primitives` is 0.
  void add(std::uint32_t instance, const std::vector<std::uint32_t>* chosen,
           std::uint64_t primitives);

  std::vector<Part> parts_;  ///< only parts with at least one primitive
  /// Numbers of the wanted primitives of a group, if an instance keeps the materials of the group's
  /// shapes. The entry of kNoGroup is for the loose shapes.
  std::map<GroupId, std::vector<std::uint32_t>> chosen_;
};

}  // namespace bandsaw
