#pragma once

// A material at a point, seen from one direction: which light it sends there. A closed set, each a
// triple of sample, value and density that belong together.
//
// All directions are unit vectors that point away from the surface. `wo` is where the light goes
// (towards the camera), `wi` where it comes from. Values carry the cosine: f(wo, wi) |cos(wi,
// shading normal)|. Densities are by solid angle.

#include <optional>
#include <variant>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/bsdf_sample.h"
#include "renderlib/material/material.h"
#include "renderlib/material/principled_bsdf.h"
#include "renderlib/material/rough_dielectric.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Lambert: f = reflectance / pi, on both sides of the surface.
struct DiffuseBsdf {
  SidedNormals normal;
  Rgb reflectance;
};

/// The mirror direction plus a uniform point in a ball of radius `fuzz` (Shirley et al., "Ray
/// Tracing in One Weekend", 10.6); what ends up below the surface is absorbed. The value is
/// reflectance times the density, so every sample weighs the same.
struct FuzzyMetalBsdf {
  SidedNormals normal;
  Rgb reflectance;
  Vec3 mirror;      ///< the mirror direction of wo
  double fuzz = 0;  ///< (0, 1]
};

/// A mirror: one direction, no density.
struct MirrorBsdf {
  Rgb reflectance;
  Vec3 mirror;
};

/// Smooth glass: two directions, chosen by the Fresnel reflectance; no density.
struct DielectricBsdf {
  SidedNormals normal;
  Vec3 wo;
  double eta = 1;  ///< index on the other side over index on this side
};

/// Nothing is scattered.
struct BlackBsdf {};

using Bsdf = std::variant<BlackBsdf, DiffuseBsdf, FuzzyMetalBsdf, MirrorBsdf, DielectricBsdf,
                          RoughDielectricBsdf, PrincipledBsdf>;

/// Fuzz below this is a mirror: it spreads light by less than a thousandth of a pixel.
inline constexpr double kLeastFuzz = 1e-6;

/// The material of `point`, seen along `wo`. `outside_index`: the index of refraction on the side
/// of the normal (nested dielectrics; material/interiors.h).
Bsdf bsdf_at(const Material& material, absl::Span<const Texture> textures,
             const SurfacePoint& point, const Vec3& wo, double outside_index = 1);

/// u, v, lobe in [0, 1). Nothing: the light is absorbed.
std::optional<BsdfSample> sample(const Bsdf& bsdf, double u, double v, double lobe);

/// Zero for the directions of mirrors and glass: they have no density.
BsdfValue evaluate(const Bsdf& bsdf, const Vec3& wi);

/// Whether evaluate() can be other than zero: whether looking for lights is worth a shadow ray.
bool has_density(const Bsdf& bsdf);

/// Whether it can be other than zero for light from behind the surface.
bool has_density_behind(const Bsdf& bsdf);

}  // namespace bandsaw
