#pragma once

// Openings through which the background lights a room, for example windows. At a surface, path
// tracing also samples a direction through one of the openings, uniformly by solid angle, because
// most other directions end at a wall (Bitterli, Novák and Jarosz 2015, "Portal-Masked Environment
// Map Sampling", section 2: portals).

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "renderlib/math/vec.h"
#include "renderlib/sampling/spherical_rectangle.h"

namespace bandsaw {

/// The rectangle corner + a u + b v, a and b in [0, 1]; u and v are perpendicular.
struct Portal {
  Vec3 corner;
  Vec3 u;
  Vec3 v;

  /// Returns true if the ray from `from` in this direction passes through the portal.
  bool passes(const Vec3& from, const Vec3& direction) const;
};

/// The portals of a scene; immutable. Without portals, sample() returns std::nullopt.
class Portals {
 public:
  static constexpr std::size_t kMaxPortals = 8;

  struct Sample {
    Vec3 direction;  ///< unit
    double pdf = 0;  ///< by solid angle; > 0, finite
  };

  Portals() = default;
  /// `portals` MUST NOT have more than kMaxPortals elements.
  explicit Portals(std::vector<Portal> portals) : portals_(std::move(portals)) {}

  bool empty() const { return portals_.empty(); }
  const std::vector<Portal>& portals() const { return portals_; }

  /// Returns a direction from `from` through one of the portals. Returns std::nullopt if the solid
  /// angle of each portal, as seen from `from`, is too small. choice, u, v in [0, 1).
  std::optional<Sample> sample(const Vec3& from, double choice, double u, double v) const;
  /// Returns the pdf, by solid angle, with which sample() returns this unit direction.
  double pdf(const Vec3& from, const Vec3& direction) const;

 private:
  /// The portals as seen from a point, in the order of portals_. An element is std::nullopt if the
  /// solid angle of its portal is too small.
  struct View {
    std::array<std::optional<SphericalRectangle>, kMaxPortals> rectangles;
    double solid_angle = 0;  ///< sum over the rectangles
  };
  /// Returns the view from the point `from`.
  View view_from(const Vec3& from) const;
  /// Returns the number of portals of `view` through which the ray passes.
  std::uint32_t passed(const View& view, const Vec3& from, const Vec3& direction) const;

  std::vector<Portal> portals_;
};

}  // namespace bandsaw
