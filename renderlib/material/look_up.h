#pragma once

// A texture at a point of a surface.

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

inline TextureCoordinates texture_coordinates(const SurfacePoint& point) {
  return {point.uv, point.uv2, point.position, point.object_position};
}

/// The colour of textures[id] at the point. Constant colours cost nothing more.
inline Rgb look_up(absl::Span<const Texture> textures, TextureId id, const SurfacePoint& point) {
  if (const auto* constant = std::get_if<ConstantTexture>(&textures[index_of(id)])) {
    return constant->value;
  }
  return evaluate(textures, id, texture_coordinates(point));
}

}  // namespace bandsaw
