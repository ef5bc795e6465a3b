#pragma once

// Coordinates of texture lookups on a surface.

#include <cstdint>

#include "renderlib/math/vec.h"

namespace bandsaw {

/// Sets of uv coordinates of a surface.
enum class UvSet : std::uint8_t { kFirst, kSecond };

/// The space of a texture that varies through space. kWorld is the world, in scene units. kObject
/// is the space of the mesh or group before its placement. On a sphere, positions in kObject are
/// relative to its centre. For other shapes outside of all meshes and groups, kObject is the world.
enum class Space : std::uint8_t { kWorld, kObject };

/// The place at which a texture is looked up.
struct TextureCoordinates {
  Vec2 uv = {};               ///< first set
  Vec2 uv2 = {};              ///< second set; the first if the surface has no second
  Vec3 position = {};         ///< world space
  Vec3 object_position = {};  ///< object space

  const Vec2& of(UvSet set) const { return set == UvSet::kFirst ? uv : uv2; }
  const Vec3& of(Space space) const { return space == Space::kWorld ? position : object_position; }
};

}  // namespace bandsaw
