#pragma once

// glTF's metallic-roughness material at a point: diffuse or thin transmission under a rough
// dielectric reflection, mixed with a rough metal, below a clear coat. One scattering at each GGX
// lobe, as glTF 2.0, appendix B.
//
// Where glTF's mixing would give more light than arrives, less is given: what the reflection takes
// is taken from the layer below by the albedo of the reflection in both directions (Kelemen and
// Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model", eq. 5), so that no
// direction sends out more than comes in, and exchanging wo and wi changes nothing. Fresnel is
// Schlick's.

#include <array>
#include <optional>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/bsdf_sample.h"
#include "renderlib/material/material.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// A GGX lobe as wo sees it.
struct GgxLobe {
  double roughness = 1;
  double alpha = 1;
};

struct PrincipledBsdf {
  SidedNormals normal;
  Vec3 coat_normal;  ///< without the normal map of what is below; with its own
  Vec3 wo;
  Rgb base;
  double metallic = 0;
  double transmission = 0;
  double f0 = 0.04;  ///< of what is not metal
  GgxLobe surface;
  double coat = 0;
  GgxLobe coating;
  double coat_albedo = 0;  ///< what the coat reflects of wo's light, times `coat`
  double matte_share = 1;  ///< what the reflection leaves, seen along wo, over the mean of that
  /// Which lobe is sampled: coat, reflection, diffuse, transmission. Their sum is 1, or 0: black.
  std::array<double, 4> chances{};
};

/// `normal` is the side of wo.
PrincipledBsdf principled_at(const Principled& material, absl::Span<const Texture> textures,
                             const SurfacePoint& point, const SidedNormals& normal, const Vec3& wo);

std::optional<BsdfSample> sample(const PrincipledBsdf& bsdf, double u, double v, double lobe);
BsdfValue evaluate(const PrincipledBsdf& bsdf, const Vec3& wi);

}  // namespace bandsaw
