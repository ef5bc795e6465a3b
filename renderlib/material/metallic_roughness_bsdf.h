#pragma once

// BSDF of glTF's metallic-roughness material. Its dielectric part is a diffuse or thin transmissive
// layer below a rough reflection. This part is mixed with a rough metal, and both are below a clear
// coat. Each GGX lobe has single scattering, as in glTF 2.0, appendix B.
//
// Where glTF's mixing would not conserve energy, less is reflected. The layer below gets the light
// that is not reflected, according to the reflection's albedo in both directions (Kelemen and
// Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model", eq. 5). So the
// BSDF never scatters more light than comes in from a direction, and it is reciprocal. Fresnel
// reflectance is Schlick's.

#include <array>
#include <optional>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/bsdf_sample.h"
#include "renderlib/material/material.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Parameters of a GGX lobe.
struct GgxLobe {
  double roughness = 1;  ///< [0, 1]
  double alpha = 1;      ///< square of the roughness, at least kMinAlpha (material/ggx.h)
};

struct MetallicRoughnessBsdf {
  SidedNormals normal;
  /// Shading normal of the coat. The coat's own normal map bends it; the normal map of the layer
  /// below does not.
  Vec3 coat_normal;
  Vec3 wo;
  Rgb base;                 ///< base colour
  double metallic = 0;      ///< [0, 1]
  double transmission = 0;  ///< share of the light below the reflection that is transmitted, [0, 1]
  double f0 = 0.04;         ///< reflectance of the dielectric part at normal incidence
  GgxLobe surface;          ///< of reflection and transmission
  double coat = 0;          ///< weight of the coat, [0, 1]
  GgxLobe coating;          ///< of the coat
  double coat_albedo = 0;   ///< albedo of the coat seen along wo, times `coat`
  /// Share of light along wo that is not reflected, divided by the mean of this share over all
  /// directions.
  double matte_share = 1;
  /// Selection probabilities of the lobes: coat, reflection, diffuse, transmission. They sum to 1,
  /// or to 0 if the BSDF is black.
  std::array<double, 4> chances{};
};

/// Returns the BSDF. `normal` is on the side of wo, and the relief has not bent it.
MetallicRoughnessBsdf metallic_roughness_at(const MetallicRoughness& material, const Relief& relief,
                                            absl::Span<const Texture> textures,
                                            const SurfacePoint& point, const SidedNormals& normal,
                                            const Vec3& wo);
/// sample() and evaluate() are those of material/bsdf.h for this kind.
std::optional<BsdfSample> sample(const MetallicRoughnessBsdf& bsdf, double u, double v,
                                 double lobe);
BsdfValue evaluate(const MetallicRoughnessBsdf& bsdf, const Vec3& wi);
/// Returns the value of the diffuse part alone.
Rgb diffuse_part(const MetallicRoughnessBsdf& bsdf, const Vec3& wi);

}  // namespace bandsaw
