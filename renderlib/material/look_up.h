#pragma once

// Texture lookup at a point of a surface.

#include <algorithm>
#include <optional>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

inline TextureCoordinates texture_coordinates(const SurfacePoint& point) {
  return {point.uv, point.uv2, point.position, point.object_position};
}

/// Returns the colour of textures[id] at the point. Constant colours have a fast path.
inline Rgb look_up(absl::Span<const Texture> textures, TextureId id, const SurfacePoint& point) {
  if (const auto* constant = std::get_if<ConstantTexture>(&textures[index_of(id)])) {
    return constant->value;
  }
  return evaluate(textures, id, texture_coordinates(point));
}

/// Returns a reflectance times `vertices`, the vertex colour, each channel clamped to 1.
inline Rgb tinted(const Rgb& reflectance, const Rgb& vertices) {
  const Rgb c = reflectance * vertices;
  return {std::min(c.r, 1.0f), std::min(c.g, 1.0f), std::min(c.b, 1.0f)};
}

/// Returns the parameter `number` times the luminance of its map, clamped to [0, 1]; `number`
/// itself if there is no map.
inline double mapped_number(absl::Span<const Texture> textures, double number,
                            const std::optional<TextureId>& map, const SurfacePoint& point) {
  return map ? std::clamp(number * double{luminance(look_up(textures, *map, point))}, 0.0, 1.0)
             : number;
}

/// Returns an index of refraction: 1 where its map is black, `index` where its map is white, and
/// `index` everywhere if there is no map.
inline double mapped_index(absl::Span<const Texture> textures, double index,
                           const std::optional<TextureId>& map, const SurfacePoint& point) {
  return map ? 1 + mapped_number(textures, 1, map, point) * (index - 1) : index;
}

}  // namespace bandsaw
