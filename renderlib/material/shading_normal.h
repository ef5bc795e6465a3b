#pragma once

// The normal that a surface is shaded with.

#include <optional>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// The shading normal bent by a texel of a normal map (0.5 + 0.5 n in the frame along_u, along_v,
/// shading normal; glTF 2.0, 3.9.3), on the outside. Where the uvs give no frame, any frame around
/// the normal. Unit. `placed`: how the map lies on the uvs; its own axes count.
Vec3 mapped_normal(const SurfacePoint& point, const Rgb& texel, double scale,
                   const UvTransform& placed = {});

/// The same with the map's texel at the point, as it is placed.
Vec3 mapped_normal(const SurfacePoint& point, absl::Span<const Texture> textures, TextureId map,
                   double scale);

/// Whose along_u and along_v mapped_normal needs: the set of the normal map, or else of the coat's.
/// Nothing: the material has neither.
std::optional<UvSet> normal_uv_set(const Principled& material, absl::Span<const Texture> textures);

/// `n`, bent just so far towards `geometric` that both wo and its mirror image lie above the
/// surface: no black rims and no light from behind. All are unit vectors, dot(wo, geometric) >= 0.
/// Continuous in all of them.
Vec3 visible_normal(const Vec3& n, const Vec3& geometric, const Vec3& wo);

}  // namespace bandsaw
