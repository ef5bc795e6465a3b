#include "renderlib/material/shading_normal.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/fresnel.h"
#include "renderlib/sampling/basis.h"

namespace bandsaw {
namespace {

/// The frame of the uvs made orthonormal around the normal; mirrored where the uvs are.
Basis uv_basis(const SurfacePoint& point) {
  const Vec3& n = point.shading_normal;
  const double size = max_abs(point.along_u);
  if (!(size > 0) || !std::isfinite(size)) {
    return orthonormal_basis(n);
  }
  const Vec3 u = point.along_u / size;
  const Vec3 along = u - n * dot(n, u);
  const double length_along = length(along);
  if (!(length_along > 1e-6)) {
    return orthonormal_basis(n);
  }
  const Vec3 x = along / length_along;
  const Vec3 y = cross(n, x);
  return {x, dot(y, point.along_v) < 0 ? -y : y, n};
}

}  // namespace

Vec3 mapped_normal(const SurfacePoint& point, const Rgb& texel, double scale) {
  const Vec3 local{(2.0 * texel.r - 1) * scale, (2.0 * texel.g - 1) * scale,
                   std::max(2.0 * texel.b - 1, 1e-3)};
  return normalize(uv_basis(point).to_world(local));
}

Vec3 visible_normal(const Vec3& n, const Vec3& geometric, const Vec3& wo) {
  const double least = std::min(0.01, 0.9 * dot(geometric, wo));
  const Vec3 mirror = mirrored(wo, n);
  const double above = dot(mirror, geometric);
  if (above >= least && dot(wo, n) > 0) {
    return n;
  }
  const Vec3 lifted = mirror + geometric * std::max(0.0, least - above);
  const double size = length(lifted);
  if (!(size > 1e-12)) {
    return geometric;
  }
  const Vec3 half = wo + lifted / size;
  const double half_size = length(half);
  if (!(half_size > 1e-9)) {
    return geometric;
  }
  const Vec3 bent = half / half_size;
  return dot(wo, bent) > 0 ? bent : geometric;
}

}  // namespace bandsaw
