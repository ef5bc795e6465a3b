#pragma once

// Thin sheets that do not refract light: clear panes, and sheets that reflect and transmit
// diffusely.

#include <optional>

#include "renderlib/material/bsdf_sample.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// A clear pane: delta reflection and straight transmission. With the reflectance R of a face, the
/// pane reflects R + (1 - R)^2 R / (1 - R^2) = 2 R / (1 + R) and transmits the rest.
struct ThinDielectricBsdf {
  SidedNormals normal;
  Vec3 wo;
  Rgb reflected;              ///< reflected share of the light times ThinDielectric::specular
  Rgb transmitted;            ///< transmitted share times ThinDielectric::transmission
  double reflection = 0;      ///< probability with which the reflection is sampled
  bool free_passage = false;  ///< light that passes does not count towards max_depth
};
/// Returns the BSDF; `normal` is on the side of wo. material/bsdf.h documents sample().
ThinDielectricBsdf thin_dielectric(const ThinDielectric& pane, const SidedNormals& normal,
                                   const Vec3& wo);
std::optional<BsdfSample> sample(const ThinDielectricBsdf& bsdf, double lobe);

/// Lambertian reflection and transmission: reflectance / pi and transmittance / pi.
struct DiffuseTransmissionBsdf {
  SidedNormals normal;
  Rgb reflectance;
  Rgb transmittance;
  double reflection = 0;  ///< probability with which the reflection is sampled
};

/// Returns the BSDF; `normal` is on the side of wo. Where the sum of reflectance and transmittance
/// exceeds 1 in a channel, both are scaled so that it is 1. material/bsdf.h documents sample()
/// and evaluate().
DiffuseTransmissionBsdf diffuse_transmission(const SidedNormals& normal, const Rgb& reflectance,
                                             const Rgb& transmittance);
std::optional<BsdfSample> sample(const DiffuseTransmissionBsdf& bsdf, double u, double v,
                                 double lobe);
BsdfValue evaluate(const DiffuseTransmissionBsdf& bsdf, const Vec3& wi);

}  // namespace bandsaw
