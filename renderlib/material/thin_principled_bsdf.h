#pragma once

// The principled BSDF of Mitsuba 3 for thin sheets: rough reflection and transmission without
// refraction, and diffuse reflection and transmission. Both sides of a sheet scatter light in the
// same way.

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

struct ThinPrincipledBsdf {
  Vec3 geometric;  ///< geometric normal on the side of wo
  /// z is the shading normal, dot(wo, z) > 0. If the facets are anisotropic, x lies along the uv
  /// coordinate u (facet_frame() in shading_normal.h).
  Basis frame;
  Vec3 o;            ///< wo in the frame
  double eta = 1.5;  ///< index of refraction of the sheet
  Facets facets;     ///< facets of the reflection
  Facets straight;   ///< facets of the transmission
  DisneyDiffuse diffuse;
  double spec_trans = 0;  ///< share of the specular lobes, [0, 1]; the rest is diffuse
  double spec_tint = 0;   ///< [0, 1]
  double diff_trans = 0;  ///< share of the diffuse light that is transmitted, [0, 1]
  /// Selection probabilities: specular reflection, specular transmission, diffuse reflection,
  /// diffuse transmission. They sum to 1, or to 0 if the BSDF is black.
  std::array<double, 4> chances{};
};

/// Returns the BSDF; `normal` is on the side of wo.
ThinPrincipledBsdf thin_principled_at(const ThinPrincipled& material,
                                      absl::Span<const Texture> textures, const SurfacePoint& point,
                                      const SidedNormals& normal, const Vec3& wo);
/// sample() and evaluate() are those of material/bsdf.h for this kind.
std::optional<BsdfSample> sample(const ThinPrincipledBsdf& bsdf, double u, double v, double lobe);
BsdfValue evaluate(const ThinPrincipledBsdf& bsdf, const Vec3& wi);

}  // namespace bandsaw
