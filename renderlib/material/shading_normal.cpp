// A texel of a normal map is a direction in the frame of the uvs; a height map is differentiated
// along the uvs. Both give a new shading normal.

#include "renderlib/material/shading_normal.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderlib/base/overloaded.h"
#include "renderlib/material/fresnel.h"
#include "renderlib/material/look_up.h"
#include "renderlib/sampling/basis.h"

namespace bandsaw {
namespace {

const ImageTexture* image_at(absl::Span<const Texture> textures, TextureId id) {
  return std::get_if<ImageTexture>(&textures[index_of(id)]);
}

/// Directions in which two coordinates increase, of any length.
struct Directions {
  Vec3 u;
  Vec3 v;
};

/// Returns the directions in which the map's own coordinates increase. `uv` are the directions of
/// the uvs, and `placed` is the map's transform of the uvs. The inverse of this transform, without
/// the division by its determinant, is applied to `uv`.
Directions along_map(const Directions& uv, const UvTransform& placed) {
  const auto& [a, b, x, d, e, y] = placed.m;
  const double sign = a * e - b * d < 0 ? -1 : 1;
  return {(uv.u * e - uv.v * d) * sign, (uv.v * a - uv.u * b) * sign};
}

bool is_anisotropic(const Material& material) {
  return std::visit(
      Overloaded{[](const Conductor& m) { return !m.surface.isotropic(); },
                 [](const Dielectric& m) { return m.surface && !m.surface->isotropic(); },
                 [](const Principled& m) { return m.anisotropic.value > 0; },
                 [](const ThinPrincipled& m) { return m.anisotropic.value > 0; },
                 [](const auto&) { return false; }},
      material.kind);
}

UvSet set_of(absl::Span<const Texture> textures, TextureId map) {
  const ImageTexture* image = image_at(textures, map);
  return image == nullptr ? UvSet::kFirst : image->uv_set;
}

/// Returns the step of a central difference of the height map `map`, as a multiple of `change`, a
/// change of the texture coordinates. The step is 2^-14, or 2^-14 of a repetition if the map
/// repeats more than once along `change`. So the difference spans at most one texel of an image
/// with a side of up to 8192 texels. Heights are rounded to floats, which changes the slope by
/// about 2^-11 of the height per repetition. This error is not visible, but shorter steps would
/// increase it.
double difference_step(absl::Span<const Texture> textures, TextureId map,
                       const TextureCoordinates& change) {
  return 0x1p-14 / std::max(1.0, repetitions(textures, map, change));
}

/// Returns the frame of the uvs, made orthonormal around the normal n; it is left-handed where the
/// uvs are mirrored. Returns any frame around n if u has no direction or is almost parallel to n.
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
  // The normal stays above the surface, even if the texel points below it.
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

Vec3 bent_normal(const Relief& relief, absl::Span<const Texture> textures,
                 const SurfacePoint& point) {
  if (relief.normal) {
    return mapped_normal(point, textures, *relief.normal, relief.normal_scale);
  }
  return relief.height ? displaced_normal(point, textures, *relief.height, relief.height_scale)
                       : point.shading_normal;
}

UvSets uv_sets_of(const Material& material, absl::Span<const Texture> textures) {
  UvSets sets;
  const auto add = [&](const std::optional<TextureId>& map) {
    if (map) {
      (set_of(textures, *map) == UvSet::kSecond ? sets.second : sets.first) = true;
    }
  };
  add(material.relief.normal);
  add(material.relief.height);
  if (const auto* layered = std::get_if<MetallicRoughness>(&material.kind)) {
    add(layered->coat_normal);
  }
  sets.first = sets.first || is_anisotropic(material);
  return sets;
}

Vec3 displaced_normal(const SurfacePoint& point, absl::Span<const Texture> textures, TextureId map,
                      double scale) {
  const bool second = set_of(textures, map) == UvSet::kSecond;
  const Vec3& n = point.shading_normal;
  const auto slope = [&](const Vec2& toward, const Vec3& along) {
    const TextureCoordinates change{toward, toward, along, {}};
    const double step = difference_step(textures, map, change);
    const auto height = [&](double by) {
      TextureCoordinates at = texture_coordinates(point);
      at.uv = at.uv + change.uv * by;
      at.uv2 = at.uv2 + change.uv2 * by;
      at.position = at.position + change.position * by;
      return double{luminance(evaluate(textures, map, at))};
    };
    return (height(step) - height(-step)) / (2 * step);
  };
  const Vec3& u = second ? point.along_u2 : point.along_u;
  const Vec3& v = second ? point.along_v2 : point.along_v;
  const Vec3 raised_u = u + n * (scale * slope({1, 0}, u) - dot(n, u));
  const Vec3 raised_v = v + n * (scale * slope({0, 1}, v) - dot(n, v));
  const Vec3 bent = cross(raised_u, raised_v);
  const double size = length(bent);
  if (!(size > 0) || !std::isfinite(size)) {
    return n;
  }
  return dot(bent, n) < 0 ? bent / -size : bent / size;
}

Basis facet_frame(const SurfacePoint& point, const Vec3& n, bool isotropic) {
  return isotropic ? orthonormal_basis(n) : uv_basis(n, {point.along_u, point.along_v});
}

Vec3 facing_normal(const Vec3& n, const Vec3& geometric, const Vec3& wo) {
  return dot(wo, n) > 0 ? n : visible_normal(n, geometric, wo);
}

Vec3 visible_normal(const Vec3& n, const Vec3& geometric, const Vec3& wo) {
  // Minimum cosine of the mirror image to the geometric normal: 0.01, or less where wo itself is
  // close to the surface.
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
