#pragma once

// The principled BSDF of Mitsuba 3 for solid bodies: a rough specular reflection that is mixed from
// a dielectric and a metal, refraction, diffuse light with sheen, and a clear coat. As Mitsuba
// defines it, the layers are added up, and no layer attenuates another. So at grazing angles,
// bright base colours can reflect more light than they receive.

#include <array>
#include <optional>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/bsdf_sample.h"
#include "renderlib/material/disney.h"
#include "renderlib/material/material.h"
#include "renderlib/material/microfacets.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

struct PrincipledBsdf {
  Vec3 geometric;  ///< geometric normal on the side of wo
  /// z is the shading normal, dot(wo, z) > 0. If the facets are anisotropic, x lies along the uv
  /// coordinate u (facet_frame() in shading_normal.h).
  Basis frame;
  Vec3 o;  ///< wo in the frame
  /// True if wo is inside the body. Then only specular reflection and refraction are present.
  bool inside = false;
  double eta = 1.5;  ///< index beyond the surface over index on this side
  Facets facets;
  DisneyDiffuse diffuse;
  double metallic = 0;
  double spec_tint = 0;
  double refracting = 0;  ///< (1 - metallic) spec_trans
  double matte = 0;       ///< (1 - metallic) (1 - spec_trans)
  double clearcoat = 0;
  double coat_alpha = 0.1;
  /// Selection probabilities: the specular lobes together, diffuse, clear coat. They sum to 1, or
  /// to 0 if the BSDF is black.
  std::array<double, 3> chances{};
};

/// Returns the BSDF. `normal` is on the side of wo. `outside` is true if wo is on the side of the
/// surface's geometric normal.
PrincipledBsdf principled_at(const Principled& material, absl::Span<const Texture> textures,
                             const SurfacePoint& point, const SidedNormals& normal, bool outside,
                             const Vec3& wo);
/// sample() and evaluate() are those of material/bsdf.h for this kind.
std::optional<BsdfSample> sample(const PrincipledBsdf& bsdf, double u, double v, double lobe);
BsdfValue evaluate(const PrincipledBsdf& bsdf, const Vec3& wi);

}  // namespace bandsaw
