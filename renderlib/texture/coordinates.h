#pragma once

// Coordinates of texture lookups on a surface.

#include <cstdint>

#include "renderlib/math/vec.h"

namespace bandsaw {

/// Sets of uv coordinates of a surface.
enum class UvSet : std::uint8_t { kFirst, kSecond };

/// The space of a solid texture. World: scene units. Object: the mesh's own space, before its
/// placement; for a sphere, scene units from its centre; for a quad and a triangle, which have no
/// other space, the world.
enum class Space : std::uint8_t { kWorld, kObject };

struct TextureCoordinates {
  Vec2 uv = {};               ///< first set
  Vec2 uv2 = {};              ///< second set; the first if the surface has no second
  Vec3 position = {};         ///< world space
  Vec3 object_position = {};  ///< object space

  const Vec2& of(UvSet set) const { return set == UvSet::kFirst ? uv : uv2; }
  const Vec3& of(Space space) const { return space == Space::kWorld ? position : object_position; }
};

}  // namespace bandsaw
