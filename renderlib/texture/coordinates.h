#pragma once

// Coordinates of texture lookups on a surface.

#include <cstdint>

#include "renderlib/math/vec.h"

namespace bandsaw {

/// Sets of uv coordinates of a surface.
enum class UvSet : std::uint8_t { kFirst, kSecond };

/// The space of a texture that varies through space. World: scene units. Object: the space of the
/// mesh or group before its placement; for a sphere, positions relative to its centre; for other
/// shapes of no mesh and no group, the world.
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
