#pragma once

// Where on a surface a texture is looked up.

#include <cstdint>

#include "renderlib/math/vec.h"

namespace bandsaw {

/// The two sets of uv of a surface.
enum class UvSet : std::uint8_t { kFirst, kSecond };

/// In which space a solid texture lies still. World: scene units. Object: the mesh's own space,
/// before its placement; of a sphere, scene units from its centre; of a quad and a triangle, which
/// have no other space, the world.
enum class Space : std::uint8_t { kWorld, kObject };

struct TextureCoordinates {
  Vec2 uv = {};               ///< the first set
  Vec2 uv2 = {};              ///< the second set; the first where the surface has no second
  Vec3 position = {};         ///< world space
  Vec3 object_position = {};  ///< object space

  const Vec2& of(UvSet set) const { return set == UvSet::kFirst ? uv : uv2; }
  const Vec3& of(Space space) const { return space == Space::kWorld ? position : object_position; }
};

}  // namespace bandsaw
