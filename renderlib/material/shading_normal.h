#pragma once

// The normal that a surface is shaded with: the interpolated normal of the mesh, bent by a normal
// map or a height map, and kept visible from the viewer. The outside of a surface is the side of
// its geometric normal.

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns the unit shading normal on the outside, bent by `texel` of a normal map. The texel is
/// 0.5 + 0.5 n, where n is a direction in the frame of the map's uvs and the shading normal (glTF
/// 2.0, 3.9.3). `scale` multiplies the tangential part of n. `placed` is the map's transform of the
/// uvs, and `set` the set of uvs that it uses. If the uvs define no frame, any frame around the
/// normal is used.
Vec3 mapped_normal(const SurfacePoint& point, const Rgb& texel, double scale,
                   const UvTransform& placed = {}, UvSet set = UvSet::kFirst);

/// Returns the shading normal bent by the texel of the normal map `map` at the point. The transform
/// and the set of uvs are those of the map.
Vec3 mapped_normal(const SurfacePoint& point, absl::Span<const Texture> textures, TextureId map,
                   double scale);

/// Returns the unit shading normal, on the outside, of the displaced surface. The displacement
/// along the surface's normals, in scene units, is the luminance of the height map `map` times
/// `scale` (Blinn 1978, "Simulation of Wrinkled Surfaces", without the derivative of the normal).
/// The point MUST have the derivatives of the map's uvs (add_uv_derivatives). If they are zero,
/// returns the undisplaced shading normal.
Vec3 displaced_normal(const SurfacePoint& point, absl::Span<const Texture> textures, TextureId map,
                      double scale);

/// Returns true if the relief changes the shading normal.
inline bool bends(const Relief& relief) { return relief.normal || relief.height; }

/// Returns the unit shading normal on the outside, bent by the relief if there is one.
Vec3 bent_normal(const Relief& relief, absl::Span<const Texture> textures,
                 const SurfacePoint& point);

/// The sets of uvs whose directions (SurfacePoint::along_u and so on) a material needs.
struct UvSets {
  bool first = false;
  bool second = false;
};
/// Returns the sets of uvs of the material's normal maps and height map. If the facets are
/// anisotropic, the first set is included as well.
UvSets uv_sets_of(const Material& material, absl::Span<const Texture> textures);

/// Returns the frame of the facets of a rough surface, in which z is the shading normal n. If the
/// surface is anisotropic, x lies along the uv coordinate u, where u has a direction.
Basis facet_frame(const SurfacePoint& point, const Vec3& n, bool isotropic);

/// Returns n, or visible_normal() where wo is behind n. The parameters are those of
/// visible_normal().
Vec3 facing_normal(const Vec3& n, const Vec3& geometric, const Vec3& wo);

/// Returns the shading normal `n`, bent towards the geometric normal `geometric` just so far that
/// wo and its mirror image lie above the surface. This avoids black rims and light from behind. The
/// parameters are unit vectors, and dot(wo, geometric) MUST be >= 0. The result is continuous in
/// all parameters.
Vec3 visible_normal(const Vec3& n, const Vec3& geometric, const Vec3& wo);

}  // namespace bandsaw
