#pragma once

// A BSDF is a material at a point, seen from one direction. Each member of the closed set of BSDFs
// (a std::variant) has a sampling routine, a value and a pdf that agree. integrate/ scatters paths
// by sampling BSDFs.
//
// All directions are unit vectors that point away from the surface. `wo` is the outgoing direction
// of the light (towards the camera), `wi` the incoming one. Values include the cosine: f(wo, wi)
// |cos(wi, shading normal)|. Pdfs are by solid angle.

#include <optional>
#include <variant>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/bsdf_sample.h"
#include "renderlib/material/conductor.h"
#include "renderlib/material/material.h"
#include "renderlib/material/metallic_roughness_bsdf.h"
#include "renderlib/material/plastic.h"
#include "renderlib/material/principled_bsdf.h"
#include "renderlib/material/rough_dielectric.h"
#include "renderlib/material/thin.h"
#include "renderlib/material/thin_principled_bsdf.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Lambertian reflection: f = reflectance / pi, on both sides of the surface.
struct DiffuseBsdf {
  SidedNormals normal;
  Rgb reflectance;
};

/// Fuzzy metal. A sample is the mirror direction plus a uniform point in a ball of radius `fuzz`,
/// normalised (Shirley et al., "Ray Tracing in One Weekend", 10.6). Samples below the surface are
/// absorbed. The value is reflectance times the pdf, so every sample has the same weight.
struct FuzzyMetalBsdf {
  SidedNormals normal;
  Rgb reflectance;
  Vec3 mirror;      ///< mirror direction of wo
  double fuzz = 0;  ///< (0, 1]
};

/// Perfect mirror: a delta distribution.
struct MirrorBsdf {
  Rgb reflectance;
  Vec3 mirror;
};

/// Smooth dielectric: two delta directions, selected by the Fresnel reflectance.
struct DielectricBsdf {
  SidedNormals normal;
  Vec3 wo;
  double eta = 1;  ///< index beyond the surface over index on this side
};

/// Scatters nothing.
struct BlackBsdf {};

using Bsdf =
    std::variant<BlackBsdf, DiffuseBsdf, FuzzyMetalBsdf, MirrorBsdf, DielectricBsdf,
                 RoughDielectricBsdf, MetallicRoughnessBsdf, RoughConductorBsdf, PlasticBsdf,
                 ThinDielectricBsdf, DiffuseTransmissionBsdf, PrincipledBsdf, ThinPrincipledBsdf>;

/// Metal with a smaller fuzz is treated as a mirror. Its fuzz would spread light by less than a
/// thousandth of a pixel.
inline constexpr double kMinFuzz = 1e-6;

/// Returns the BSDF of `material`, which MUST NOT be a mixture, at `point`, seen along `wo`.
/// `outside_index` is the index of refraction on the side of the geometric normal (nested
/// dielectrics; material/interiors.h).
Bsdf bsdf_at(const Material& material, absl::Span<const Texture> textures,
             const SurfacePoint& point, const Vec3& wo, double outside_index = 1);

/// Samples a direction wi. u, v and lobe are random numbers in [0, 1); `lobe` chooses the lobe if
/// the BSDF has several. Returns std::nullopt if the light is absorbed.
std::optional<BsdfSample> sample(const Bsdf& bsdf, double u, double v, double lobe);

/// Returns value and pdf; zero for the delta directions of mirrors and smooth dielectrics.
BsdfValue evaluate(const Bsdf& bsdf, const Vec3& wi);

/// Returns true if evaluate() can be non-zero, so that light sampling is useful.
bool has_pdf(const Bsdf& bsdf);

/// Returns true if evaluate() can be non-zero for light from behind the surface.
bool has_pdf_behind(const Bsdf& bsdf);

/// Returns true if the surface transmits light from behind diffusely, so that sampling the lights
/// behind it is worthwhile.
bool is_diffuse_behind(const Bsdf& bsdf);

}  // namespace bandsaw
