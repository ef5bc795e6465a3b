#pragma once

// A cell holds the directions from which light arrives at one place: a few balls in space, each
// with the share of the light that comes from it. Seen from a point near the place, a ball is a
// cone of directions, which is sampled uniformly. As balls have positions, the cones follow the
// point (the parallax of Ruppert, Herholz and Lensch 2020, "Robust Fitting of Parallax-Aware
// Mixtures for Path Guiding", section 4, with cones in place of von Mises-Fisher lobes).

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/guiding/guiding_record.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Maximum number of balls of a cell.
inline constexpr std::uint32_t kMaxBalls = 8;

/// A ball from which a part of the light comes.
struct GuidingBall {
  Float3 center;
  float radius = 0;  ///< > 0
  float weight = 0;  ///< share of the light, > 0; the weights of a cell sum to 1 at most
};

/// fit_cell() makes a cell from records of light that arrived at points (guiding_record.h). A
/// GuidingField (guiding_field.h) holds many cells.
struct GuidingCell {
  std::uint32_t count = 0;  ///< number of balls
  float irradiance = 0;     ///< at the place, estimated from the cell's records
  /// Best probability, in [0, 1/2], of sampling a direction towards the balls if the point receives
  /// no other light. With the remaining probability the direction is sampled from the BSDF.
  float share = 0;
  /// Expected second moment of a sampled direction's contribution at a diffuse surface without
  /// guiding, in units of the squared mean. Estimated from light that was left out of the fit.
  float moment = 1;
  /// The same moment without guiding, for photons: computed from GuidingRecord::solid_angle as if
  /// mirrors and glass did not change the solid angle of the light. 0 if it is not known.
  float moment_of_lights = 0;
  float guided_moment = 1;  ///< the expected second moment with guiding by `share`
  std::array<GuidingBall, kMaxBalls> balls;
};

/// Returns the cell that fits the records. All records MUST be of one kind, and their normals
/// similar. If the records are too few or their weights too unequal, the cell has no balls. The
/// result depends only on the records and their order.
GuidingCell fit_cell(absl::Span<const GuidingRecord> records);

/// The cells that guide the directions at a point: one fitted to paths and one fitted to photons.
/// Each may be null.
struct GuidingCells {
  const GuidingCell* paths = nullptr;
  const GuidingCell* photons = nullptr;
};

/// Probabilities with which a direction is sampled towards the balls of the cell of paths and of
/// the cell of photons.
struct GuidingShares {
  double paths = 0;
  double photons = 0;
};

/// Returns the shares. Let p be the irradiance of the cell of photons, divided by the sum of the
/// irradiances of both cells. The share of photons is p, limited to [1/8, 1/2], or 0 if the light
/// of the photons is hardly noticeable. The share of paths is (1 - share of photons) times the
/// GuidingCell::share of the cell of paths. The share of a cell without balls is 0.
GuidingShares shares_of(const GuidingCells& cells);

/// Cells as seen from a point: cones of directions, from which paths sample.
class GuidingCones {
 public:
  /// Guides nothing. (The arrays are left uninitialised: they are large.)
  GuidingCones() : count_(0), share_(0) {}
  /// `normal`: unit, on the side of the surface that receives light. Balls below the surface or
  /// around the point are left out, and share() is reduced by their weights.
  GuidingCones(const GuidingCells& cells, const Vec3& position, const Vec3& normal);

  /// Returns the probability with which a direction is to be sampled from the cones; 0: never.
  double share() const { return share_; }

  /// Returns a unit direction; choice, u, v in [0, 1). share() MUST be > 0.
  Vec3 sample(double choice, double u, double v) const;
  /// Returns the pdf of sample() by solid angle. 0 if share() is 0.
  double pdf(const Vec3& direction) const;

 private:
  std::uint32_t count_;
  double share_;
  /// Adds the cones of a cell, which is sampled with the probability `share`.
  void add(const GuidingCell& cell, double share, const Vec3& position, const Vec3& normal);

  static constexpr std::uint32_t kMaxCones = 2 * kMaxBalls;
  // For each cone:
  double x_[kMaxCones];  ///< x, y, z: the axis, a unit vector
  double y_[kMaxCones];
  double z_[kMaxCones];
  double one_minus_cos_[kMaxCones];  ///< 1 - cos of the half-angle
  double weight_[kMaxCones];         ///< probability of the cone; the weights sum to 1
  double density_[kMaxCones];        ///< weight by solid angle
};

}  // namespace bandsaw
