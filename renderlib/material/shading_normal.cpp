#include "renderlib/material/shading_normal.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderlib/material/fresnel.h"
#include "renderlib/material/look_up.h"
#include "renderlib/sampling/basis.h"

namespace bandsaw {
namespace {

const ImageTexture* image_at(absl::Span<const Texture> textures, TextureId id) {
  return std::get_if<ImageTexture>(&textures[index_of(id)]);
}

struct Directions {
  Vec3 u;
  Vec3 v;
};

/// Returns the directions in which the map's own coordinates increase, of any length: the inverse
/// of the map's transform, without the division by its determinant.
Directions along_map(const Directions& uv, const UvTransform& placed) {
  const auto& [a, b, x, d, e, y] = placed.m;
  const double sign = a * e - b * d < 0 ? -1 : 1;
  return {(uv.u * e - uv.v * d) * sign, (uv.v * a - uv.u * b) * sign};
}

UvSet set_of(absl::Span<const Texture> textures, TextureId map) {
  const ImageTexture* image = image_at(textures, map);
  return image == nullptr ? UvSet::kFirst : image->uv_set;
}

/// The frame of the uvs made orthonormal around the normal; mirrored where the uvs are.
Basis uv_basis(const Vec3& n, const Directions& uv) {
  const double size = max_abs(uv.u);
  if (!(size > 0) || !std::isfinite(size)) {
    return orthonormal_basis(n);
  }
  const Vec3 u = uv.u / size;
  const Vec3 along = u - n * dot(n, u);
  const double length_along = length(along);
  if (!(length_along > 1e-6)) {
    return orthonormal_basis(n);
  }
  const Vec3 x = along / length_along;
  const Vec3 y = cross(n, x);
  return {x, dot(y, uv.v) < 0 ? -y : y, n};
}

}  // namespace

Vec3 mapped_normal(const SurfacePoint& point, const Rgb& texel, double scale,
                   const UvTransform& placed, UvSet set) {
  const Directions uv = set == UvSet::kSecond ? Directions{point.along_u2, point.along_v2}
                                              : Directions{point.along_u, point.along_v};
  const Vec3 local{(2.0 * texel.r - 1) * scale, (2.0 * texel.g - 1) * scale,
                   std::max(2.0 * texel.b - 1, 1e-3)};
  const Basis frame = uv_basis(point.shading_normal, along_map(uv, placed));
  return normalize(frame.to_world(local));
}

Vec3 mapped_normal(const SurfacePoint& point, absl::Span<const Texture> textures, TextureId map,
                   double scale) {
  const ImageTexture* image = image_at(textures, map);
  return mapped_normal(point, look_up(textures, map, point), scale,
                       image == nullptr ? UvTransform{} : image->uv_transform,
                       set_of(textures, map));
}

NormalUvSets normal_uv_sets(const Principled& material, absl::Span<const Texture> textures) {
  NormalUvSets sets;
  for (const std::optional<TextureId>& map : {material.normal, material.coat_normal}) {
    if (map) {
      (set_of(textures, *map) == UvSet::kSecond ? sets.second : sets.first) = true;
    }
  }
  return sets;
}

Vec3 visible_normal(const Vec3& n, const Vec3& geometric, const Vec3& wo) {
  const double least = std::min(0.01, 0.9 * dot(geometric, wo));
  const Vec3 mirror = mirrored(wo, n);
  const double above = dot(mirror, geometric);
  if (above >= least && dot(wo, n) > 0) {
    return n;
  }
  const Vec3 lifted = mirror + geometric * std::max(0.0, least - above);
  const double size = length(lifted);
  if (!(size > 1e-12)) {
    return geometric;
  }
  const Vec3 half = wo + lifted / size;
  const double half_size = length(half);
  if (!(half_size > 1e-9)) {
    return geometric;
  }
  const Vec3 bent = half / half_size;
  return dot(wo, bent) > 0 ? bent : geometric;
}

}  // namespace bandsaw
