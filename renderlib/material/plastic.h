#pragma once

// A diffuse surface below a smooth or rough dielectric coat: `plastic` and `roughplastic` of
// Mitsuba 3. The diffuse part is r / (1 - c r') T(wo) T(wi) / (eta^2 pi). Here r is the
// reflectance, T is the transmittance of the coat, c is the internal reflectance of the coat, and
// r' is r if the material is nonlinear, otherwise 1 (Weidlich and Wilkie 2007, "Arbitrarily Layered
// Micro-Facet Surfaces"). The factor 1 / (1 - c r') is the sum of a geometric series, which has a
// term for each further reflection inside the coat.

#include <optional>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/bsdf_sample.h"
#include "renderlib/material/material.h"
#include "renderlib/material/microfacets.h"
#include "renderlib/material/plastic_coat.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

struct PlasticBsdf {
  SidedNormals normal;  ///< dot(wo, shading) > 0
  Vec3 wo;
  Rgb diffuse;                   ///< r / (1 - c r') / eta^2
  Rgb specular;                  ///< factor of the coat's reflection
  double eta = 1.5;              ///< index of refraction of the coat
  PlasticCoat::At coat{};        ///< T and c
  std::optional<Facets> facets;  ///< absent if the coat is smooth: a delta reflection
  double passing = 0;            ///< T(wo)
  double specular_chance = 0;    ///< probability with which the coat's reflection is sampled
};

/// Returns the BSDF; `normal` is on the side of wo. prepare_materials() (plastic_coat.h) MUST have
/// set the coat of the material.
PlasticBsdf plastic_at(const Plastic& material, absl::Span<const Texture> textures,
                       const SurfacePoint& point, const SidedNormals& normal, const Vec3& wo);
/// sample() and evaluate() are those of material/bsdf.h for this kind.
std::optional<BsdfSample> sample(const PlasticBsdf& bsdf, double u, double v, double lobe);
/// Returns value and pdf, without the delta reflection of a smooth coat.
BsdfValue evaluate(const PlasticBsdf& bsdf, const Vec3& wi);
/// Returns the value of the diffuse part alone.
Rgb diffuse_part(const PlasticBsdf& bsdf, const Vec3& wi);

}  // namespace bandsaw
