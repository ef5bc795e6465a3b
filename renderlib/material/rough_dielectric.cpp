#include "renderlib/material/rough_dielectric.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/fresnel.h"
#include "renderlib/material/ggx.h"
#include "renderlib/sampling/basis.h"

namespace bandsaw {
namespace {

/// Returns the Jacobian of refraction (Walter et al. 2007, eq. 17) times dot(o, h): the pdf of wi
/// by refraction at the microfacet h, divided by ggx_visible_over_cos() and by 1 - F.
double refraction_jacobian(double o_h, double i_h, double eta) {
  const double along_half = o_h + eta * i_h;  // i_h < 0
  return eta * eta * std::abs(i_h) * o_h / (along_half * along_half);
}

/// Returns true if wi is on the side of the geometric normal that its z in the shading frame
/// indicates.
bool is_consistent(const RoughDielectricBsdf& bsdf, const Vec3& wi, double local_z) {
  return dot(wi, bsdf.normal.geometric) * local_z > 0;
}

}  // namespace

std::optional<BsdfSample> sample(const RoughDielectricBsdf& bsdf, double u, double v, double lobe) {
  const Basis frame = orthonormal_basis(bsdf.normal.shading);
  const Vec3 o = frame.to_local(bsdf.wo);
  const Vec3 h = sample_ggx_visible(o, bsdf.alpha, u, v);
  const double o_h = std::min(1.0, dot(o, h));
  if (o_h <= 0) {
    return std::nullopt;
  }
  const double visible = ggx_visible_over_cos(o, h, bsdf.alpha);
  const double reflected_share = fresnel(o_h, bsdf.eta);
  BsdfSample sample;
  Vec3 i;
  if (lobe < reflected_share) {
    i = mirrored(o, h);
    if (i.z <= 0) {
      return std::nullopt;
    }
    sample.pdf = reflected_share * visible / 4;
  } else {
    const std::optional<double> cos_t = refracted_cos(o_h, bsdf.eta);
    if (!cos_t) {
      return std::nullopt;
    }
    i = refracted(o, h, *cos_t, bsdf.eta);
    if (i.z >= 0) {
      return std::nullopt;
    }
    sample.pdf = (1 - reflected_share) * visible * refraction_jacobian(o_h, dot(i, h), bsdf.eta);
    sample.compression = 1 / (bsdf.eta * bsdf.eta);
  }
  i = normalize(i);
  sample.wi = normalize(frame.to_world(i));
  sample.weight = gray(static_cast<float>(ggx_shadowing(o, i, bsdf.alpha) * sample.compression));
  if (!is_consistent(bsdf, sample.wi, i.z) || !(sample.pdf > 0) || !std::isfinite(sample.pdf)) {
    return std::nullopt;
  }
  return sample;
}

BsdfValue evaluate(const RoughDielectricBsdf& bsdf, const Vec3& wi) {
  const Basis frame = orthonormal_basis(bsdf.normal.shading);
  const Vec3 o = frame.to_local(bsdf.wo);
  const Vec3 i = frame.to_local(wi);
  if (!is_consistent(bsdf, wi, i.z)) {
    return {};
  }
  const bool reflects = i.z > 0;
  // For a refraction, the half vector -(o + eta i) points to the side of smaller index (Walter et
  // al. 2007, eq. 16); below it is flipped to the side of the normal.
  Vec3 h = reflects ? o + i : -(o + i * bsdf.eta);
  const double size = length(h);
  if (!(size > 0)) {
    return {};
  }
  h = h / std::copysign(size, h.z);
  const double o_h = std::min(1.0, dot(o, h));
  const double i_h = dot(i, h);
  if (o_h <= 0 || i_h * i.z <= 0) {
    return {};
  }
  const double reflected_share = fresnel(o_h, bsdf.eta);
  const double visible = ggx_visible_over_cos(o, h, bsdf.alpha);
  const double shadowing = ggx_shadowing(o, i, bsdf.alpha);
  BsdfValue value;
  double compression = 1;
  if (reflects) {
    value.pdf = reflected_share * visible / 4;
  } else {
    value.pdf = (1 - reflected_share) * visible * refraction_jacobian(o_h, i_h, bsdf.eta);
    compression = 1 / (bsdf.eta * bsdf.eta);
  }
  value.value = gray(static_cast<float>(value.pdf * shadowing * compression));
  return value;
}

}  // namespace bandsaw
