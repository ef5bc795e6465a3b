// Scatters a photon at a surface. At mirrors and smooth glass, both the shading normal and the
// geometric normal are tried. At other surfaces, a direction is sampled from the BSDF seen from the
// photon, and the power changes by the BSDF of the path that travels in the opposite direction.

#include "renderlib/integrate/scatter_photon.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/bsdf.h"
#include "renderlib/material/fresnel.h"
#include "renderlib/material/shading_normal.h"

namespace bandsaw {
namespace {

/// Where the geometric normal differs from the shading normal, rough surfaces sample this part of
/// the directions about the geometric normal.
constexpr double kGeometricPart = 0.125;
/// Normals with a smaller squared distance are treated as equal.
constexpr double kSameNormal = 1e-16;
/// Unit vectors with a smaller squared distance agree up to rounding.
constexpr double kSameDirection = 1e-20;

/// The two normals about which mirrors, fuzzy metal and smooth glass can scatter, unit vectors on
/// the side of the photon. These surfaces use the shading normal, except where it would send light
/// to the wrong side of the surface. The photon must be scattered about the same normal as a path
/// that travels in the opposite direction. That path's normal depends on the direction from which
/// the path comes (for_mirror() and for_glass() in material/bsdf.cpp), and this is the direction in
/// which the photon leaves. It is not known yet when the photon arrives, so both normals are tried.
struct PhotonNormals {
  Vec3 geometric;
  Vec3 shading;
  bool same;  ///< the two normals are equal
};

/// Returns the normals for a photon that comes from `in`.
PhotonNormals normals_at(const Scene& scene, const SurfacePoint& point, const Vec3& in) {
  const Vec3 shading = bent_normal(scene.material(point.material).relief, scene.textures(), point);
  const bool same = length_squared(shading - point.geometric_normal) < kSameNormal;
  return dot(in, point.geometric_normal) < 0
             ? PhotonNormals{-point.geometric_normal, -shading, same}
             : PhotonNormals{point.geometric_normal, shading, same};
}

/// Returns true if a path is scattered to `in` about `normal`. The path comes from the direction in
/// which the photon leaves, and `bsdf` is the BSDF seen from that direction.
bool path_uses_normal(const Bsdf& bsdf, const Vec3& in, const Vec3& normal) {
  if (const auto* mirror = std::get_if<MirrorBsdf>(&bsdf)) {
    return length_squared(mirror->mirror - in) < kSameDirection;
  }
  const auto* glass = std::get_if<DielectricBsdf>(&bsdf);
  return glass != nullptr &&
         std::min(length_squared(glass->normal.shading - normal),
                  length_squared(glass->normal.shading + normal)) < kSameDirection;
}

/// Returns the scattering to `out`, which was sampled with this pdf. The factor is that of the BSDF
/// for a path that comes from `out`.
PhotonScattering path_value(const Scene& scene, const SurfacePoint& point, const Vec3& in,
                            const Vec3& out, double pdf) {
  const Bsdf of_path = bsdf_at(scene.material(point.material), scene.textures(), point, out);
  const double cosines = dot(out, point.geometric_normal) / dot(in, point.geometric_normal);
  return {out, evaluate(of_path, in).value * static_cast<float>(std::abs(cosines) / pdf)};
}

/// Scatters at a mirror or at smooth glass about a normal. `bsdf`: the BSDF seen from `in`;
/// `number` selects reflection or refraction. Returns std::nullopt if no path is scattered to `in`
/// about this normal.
std::optional<PhotonScattering> scatter_about(const Scene& scene, const SurfacePoint& point,
                                              const Bsdf& bsdf, const Vec3& in,
                                              const PhotonNormals& normals, const Vec3& normal,
                                              double number) {
  const double cos_in = std::min(1.0, dot(in, normal));
  if (!(cos_in > 0)) {
    return std::nullopt;
  }
  Vec3 out = normalize(mirrored(in, normal));
  bool is_refracted = false;
  if (const auto* glass = std::get_if<DielectricBsdf>(&bsdf);
      glass != nullptr && number >= fresnel(cos_in, glass->eta)) {
    const std::optional<double> cos_out = refracted_cos(cos_in, glass->eta);
    if (!cos_out) {
      return std::nullopt;
    }
    out = normalize(refracted(in, normal, *cos_out, glass->eta));
    is_refracted = true;
  }
  const double out_geometric = dot(out, normals.geometric);
  if ((out_geometric < 0) != is_refracted) {
    return std::nullopt;
  }
  Bsdf of_path = bsdf;
  if (!normals.same) {
    of_path = bsdf_at(scene.material(point.material), scene.textures(), point, out);
    if (!path_uses_normal(of_path, in, normal)) {
      return std::nullopt;
    }
  }
  double factor = std::abs(out_geometric) / dot(in, normals.geometric);
  if (is_refracted) {
    factor *= cos_in / std::abs(dot(out, normal));
  }
  const auto* mirror = std::get_if<MirrorBsdf>(&of_path);
  const Rgb reflectance = mirror != nullptr ? mirror->reflectance : gray(1);
  return PhotonScattering{out, reflectance * static_cast<float>(factor)};
}

/// Scatters at a mirror or at smooth glass, whose BSDF seen from `in` is `bsdf`. If paths scatter
/// to `in` about both normals, one of the two ways is chosen at random, and the power is doubled.
std::optional<PhotonScattering> scatter_specular(const Scene& scene, const SurfacePoint& point,
                                                 const Bsdf& bsdf, const Vec3& in,
                                                 const Sample4& numbers) {
  const PhotonNormals normals = normals_at(scene, point, in);
  const auto about = [&](const Vec3& normal) {
    return scatter_about(scene, point, bsdf, in, normals, normal, numbers[2]);
  };
  std::optional<PhotonScattering> by_shading = about(normals.shading);
  if (normals.same) {
    return by_shading;
  }
  std::optional<PhotonScattering> by_geometric = about(normals.geometric);
  if (!by_shading || !by_geometric) {
    return by_shading ? by_shading : by_geometric;
  }
  by_shading->factor = by_shading->factor * 2;
  by_geometric->factor = by_geometric->factor * 2;
  return numbers[3] < 0.5 ? by_shading : by_geometric;
}

/// Returns the scattering into a delta direction at a surface with a smooth coat or at a pane. A
/// photon and a path take the same way in opposite directions there, and the factor differs only by
/// the cosines. Where the shading normal sends light to the wrong side of the surface, a path would
/// take another way. This difference is ignored.
PhotonScattering scatter_by_delta(const SurfacePoint& point, const Vec3& in,
                                  const BsdfSample& next) {
  const double cosines = dot(next.wi, point.geometric_normal) / dot(in, point.geometric_normal);
  return {next.wi, next.weight * static_cast<float>(std::abs(cosines) / next.compression),
          next.counts};
}

/// Samples a direction from one of two BSDFs seen from `in`, with the pdf of their mixture. Both
/// BSDFs are needed where the two normals differ, because a BSDF bends or replaces its shading
/// normal depending on the direction from which it is seen. One BSDF alone would not reach all
/// directions of paths.
std::optional<PhotonScattering> scatter_by_both(const Scene& scene, const SurfacePoint& point,
                                                const Bsdf& about_shading,
                                                const Bsdf& about_geometric, const Vec3& in,
                                                const Sample4& numbers) {
  const bool geometric = numbers[3] < kGeometricPart;
  const auto next =
      sample(geometric ? about_geometric : about_shading, numbers[0], numbers[1], numbers[2]);
  if (!next || (next->delta && geometric)) {
    return std::nullopt;
  }
  if (next->delta) {
    PhotonScattering scattering = scatter_by_delta(point, in, *next);
    scattering.factor = scattering.factor * static_cast<float>(1 / (1 - kGeometricPart));
    return scattering;
  }
  const double pdf = kGeometricPart * evaluate(about_geometric, next->wi).pdf +
                     (1 - kGeometricPart) * evaluate(about_shading, next->wi).pdf;
  return path_value(scene, point, in, next->wi, pdf);
}

/// Returns the lobe of fuzzy metal about a normal, whether or not a path would use this normal.
Bsdf fuzzy_lobe(const FuzzyMetalBsdf& metal, const Vec3& normal, const PhotonNormals& normals,
                const Vec3& in) {
  return FuzzyMetalBsdf{{normals.geometric, normals.geometric},
                        metal.reflectance,
                        normalize(mirrored(in, normal)),
                        metal.fuzz};
}

/// Returns the BSDF seen from `in`, with the geometric normal as shading normal.
Bsdf without_shading_normal(const Scene& scene, const SurfacePoint& point, const Vec3& in) {
  SurfacePoint at = point;
  at.shading_normal = point.geometric_normal;
  const Material& material = scene.material(point.material);
  if (!bends(material.relief)) {
    return bsdf_at(material, scene.textures(), at, in);
  }
  Material flat = material;
  flat.relief = {};
  return bsdf_at(flat, scene.textures(), at, in);
}

}  // namespace

std::optional<PhotonScattering> scatter_photon(const Scene& scene, const SurfacePoint& point,
                                               const Vec3& in, const Sample4& numbers) {
  const Material& material = scene.material(point.material);
  const Bsdf bsdf = bsdf_at(material, scene.textures(), point, in);
  if (std::holds_alternative<MirrorBsdf>(bsdf) || std::holds_alternative<DielectricBsdf>(bsdf)) {
    return scatter_specular(scene, point, bsdf, in, numbers);
  }
  if (const PhotonNormals normals = normals_at(scene, point, in); !normals.same) {
    const auto* metal = std::get_if<FuzzyMetalBsdf>(&bsdf);
    return metal == nullptr
               ? scatter_by_both(scene, point, bsdf, without_shading_normal(scene, point, in), in,
                                 numbers)
               : scatter_by_both(scene, point, fuzzy_lobe(*metal, normals.shading, normals, in),
                                 fuzzy_lobe(*metal, normals.geometric, normals, in), in, numbers);
  }
  const std::optional<BsdfSample> next = sample(bsdf, numbers[0], numbers[1], numbers[2]);
  if (!next) {
    return std::nullopt;
  }
  if (next->delta) {
    return scatter_by_delta(point, in, *next);
  }
  return path_value(scene, point, in, next->wi, next->pdf);
}

}  // namespace bandsaw
