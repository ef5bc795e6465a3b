#pragma once

// The normal that a surface is shaded with.

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns the shading normal bent by a texel of a normal map (0.5 + 0.5 n in the frame of the uvs
/// and the shading normal; glTF 2.0, 3.9.3), on the outside. Any frame around the normal where the
/// uvs give none. Unit. `placed`: how the map lies on its uvs; the axes of the map count. `set`:
/// the uvs of the map.
Vec3 mapped_normal(const SurfacePoint& point, const Rgb& texel, double scale,
                   const UvTransform& placed = {}, UvSet set = UvSet::kFirst);

/// The same with the map's texel at the point, as the map is placed on its own set of uvs.
Vec3 mapped_normal(const SurfacePoint& point, absl::Span<const Texture> textures, TextureId map,
                   double scale);

/// The sets of uvs of which mapped_normal needs the directions: those of the material's normal map
/// and of its coat's.
struct NormalUvSets {
  bool first = false;
  bool second = false;
};
NormalUvSets normal_uv_sets(const Principled& material, absl::Span<const Texture> textures);

/// `n`, bent just so far towards `geometric` that both wo and its mirror image lie above the
/// surface: no black rims and no light from behind. All are unit vectors, dot(wo, geometric) >= 0.
/// Continuous in all of them.
Vec3 visible_normal(const Vec3& n, const Vec3& geometric, const Vec3& wo);

}  // namespace bandsaw
