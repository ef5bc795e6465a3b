// A cell (guiding_cell.h) is a few balls in space from which light arrives at a place. Each ball,
// as seen from a point, is a cone of directions. A cone is chosen with a probability in proportion
// to the light of its ball, and then a direction is chosen uniformly within the cone.

#include <algorithm>
#include <cmath>

#include "renderlib/guiding/guiding_cell.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// Minimum of 1 - cos of a cone's half-angle: its value at about a sixth of a degree. The rounding
/// error of a cosine is far below it.
constexpr double kNarrowest = 4e-6;

}  // namespace

/// Returns the probabilities with which a direction is sampled towards the balls of the two cells
/// at a point. `cells.photons` was fitted to photons, and `cells.paths` to light that paths from
/// the camera found.
GuidingShares shares_of(const GuidingCells& cells) {
  // Weak light can still be noisy: if its source is small, it is rarely sampled, and then the
  // sample is bright. GuidingCell::moment shows this noise: it is the second moment of the cell's
  // light, sampled without guiding, in units of the squared mean of this light. All light is the
  // sum of the irradiances of both cells, and `part` is the photons' part of this sum. In units of
  // the squared mean of all light, the second moment of the photons' light is therefore
  // part^2 * moment. If that is at most kMinMoment, the noise is not noticed, and no directions are
  // sampled from the cell of photons.
  constexpr double kMinMoment = 0.001;
  constexpr double kMinShare = 0.125;
  constexpr double kMaxShare = 0.5;
  GuidingShares shares;
  if (cells.photons != nullptr && cells.photons->count > 0) {
    const double others = cells.paths != nullptr ? cells.paths->irradiance : 0;
    const double part = cells.photons->irradiance / (cells.photons->irradiance + others);
    if (part * part * cells.photons->moment > kMinMoment) {
      shares.photons = std::clamp(part, kMinShare, kMaxShare);
    }
  }
  if (cells.paths != nullptr && cells.paths->count > 0) {
    shares.paths = cells.paths->share * (1 - shares.photons);
  }
  return shares;
}

GuidingCones::GuidingCones(const GuidingCells& cells, const Vec3& position, const Vec3& normal)
    : count_(0), share_(0) {
  const GuidingShares shares = shares_of(cells);
  if (shares.photons > 0) {
    add(*cells.photons, shares.photons, position, normal);
  }
  if (shares.paths > 0) {
    add(*cells.paths, shares.paths, position, normal);
  }
  for (std::uint32_t i = 0; i < count_; ++i) {
    weight_[i] /= share_;
    density_[i] = weight_[i] * cone_pdf(one_minus_cos_[i]);
  }
}

void GuidingCones::add(const GuidingCell& cell, double share, const Vec3& position,
                       const Vec3& normal) {
  for (std::uint32_t i = 0; i < cell.count; ++i) {
    const GuidingBall& ball = cell.balls[i];
    const Vec3 to = vec3(ball.center) - position;
    const double radius = ball.radius;
    const double distance2 = length_squared(to);
    const double sin2 = radius * radius / distance2;
    // Balls around the point, and balls that are wholly below the surface, are left out.
    if (!(sin2 < 1) || dot(to, normal) <= -radius) {
      continue;
    }
    const Vec3 axis = to / std::sqrt(distance2);
    x_[count_] = axis.x;
    y_[count_] = axis.y;
    z_[count_] = axis.z;
    one_minus_cos_[count_] = std::max(one_minus_cos_from_sin2(sin2), kNarrowest);
    weight_[count_] = share * ball.weight;
    share_ += weight_[count_];
    ++count_;
  }
}

Vec3 GuidingCones::sample(double choice, double u, double v) const {
  std::uint32_t chosen = 0;
  for (double left = choice - weight_[0]; left >= 0 && chosen + 1 < count_;
       left -= weight_[chosen]) {
    ++chosen;
  }
  const Basis basis = orthonormal_basis({x_[chosen], y_[chosen], z_[chosen]});
  return normalize(basis.to_world(sample_cone(u, v, one_minus_cos_[chosen])));
}

double GuidingCones::pdf(const Vec3& direction) const {
  double sum = 0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    const double cosine = x_[i] * direction.x + y_[i] * direction.y + z_[i] * direction.z;
    sum += 1 - cosine <= one_minus_cos_[i] ? density_[i] : 0;
  }
  return share_ > 0 ? sum : 0;
}

}  // namespace bandsaw
