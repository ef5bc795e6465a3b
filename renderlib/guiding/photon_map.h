#pragma once

// A map of photons on surfaces: the irradiance at a point is estimated from the photons around it
// (Jensen 1996, "Global Illumination Using Photon Maps"). Each photon spreads its power over a disk
// of its own, which is small where photons are dense (the sample-point adaptive kernel of Breiman,
// Meisel and Purcell 1977, "Variable Kernel Estimates of Multivariate Densities"). So the sum of
// the power is kept whatever the radii are, and bright lines stay narrow.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "renderlib/base/pool.h"
#include "renderlib/base/simd.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/float3.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// A photon that arrived at a surface.
struct StoredPhoton {
  Float3 position{};        ///< relative to PhotonMap::origin
  float radius = 0;         ///< of its disk, scene units; set by PhotonMap
  Float3 normal{};          ///< geometric normal of the surface, unit, on the side of arrival
  std::uint16_t chain = 0;  ///< number of scatterings between the light and this surface
  std::uint16_t part = 0;   ///< the part of the shutter interval in which the photon travelled
  Float3 from{};            ///< unit, towards the place from which the photon came
  Rgb power{};              ///< flux: radiance x steradian x area in scene units
};

/// Immutable after construction. integrate/make_photon_maps.h makes the maps of a scene.
class PhotonMap {
 public:
  /// A disk has the area that about this many photons occupy, if the radius factor is 1. Where
  /// photons are spread evenly, disks are larger.
  static constexpr double kPhotonsOfDisk = 20;

  PhotonMap() = default;
  /// Builds the map. The positions of the photons are relative to `origin`. `radius_factor` > 0
  /// scales all radii. `seed` decides how space is divided into parts whose photons have disks of
  /// one radius. When a photon's radius is known, `share_on_surface` is called for it, on the
  /// threads of the pool. This function may reduce the radius. It returns the share of the photon's
  /// power, in (0, 1], that falls on the surface and not beyond an edge, and the power is divided
  /// by this share. The map depends on its arguments and the order of the photons, not on the
  /// threads.
  PhotonMap(std::vector<StoredPhoton> photons, const Vec3& origin, double radius_factor,
            std::uint64_t seed, Pool& pool,
            absl::FunctionRef<double(StoredPhoton&)> share_on_surface);

  /// Calls visit(photon, density) for each photon whose disk contains the point. `normal` is the
  /// unit normal of the point's surface, on the side whose irradiance is wanted. The irradiance is
  /// the sum of power * density.
  template <class Visit>
  void visit(const Vec3& position, const Vec3& normal, const Visit& visit) const;

  std::size_t size() const { return photons_.size(); }
  absl::Span<const StoredPhoton> photons() const { return photons_; }
  const Vec3& origin() const { return origin_; }
  /// Returns the memory of the map in bytes.
  std::size_t bytes() const {
    return photons_.size() * sizeof(StoredPhoton) + nodes_.size() * sizeof(Node) +
           disks_.size() * disks_[0].size() * sizeof(float);
  }

 private:
  static constexpr std::size_t kWidth = 8;  ///< boxes of a node, and photons of a leaf, at most
  /// Maximum number of nodes on the way from the root to a leaf.
  static constexpr std::size_t kMaxLevels = 80;

  /// The contents of a box: photons [first, first + photons), or node `first` if `photons` is 0.
  struct Child {
    std::uint32_t first = 0;
    std::uint32_t photons = 0;
  };
  /// A node of a tree with boxes around the disks.
  struct alignas(64) Node {
    /// low x, y, z, high x, y, z of each box; an unused box contains no point.
    std::array<std::array<float, kWidth>, 6> bounds;
    std::array<Child, kWidth> children;
  };
  /// Adds a node for the photons [first, last), and the nodes below it, and sorts these photons.
  /// `depth` is the number of divisions of space so far. Sets the box around the disks.
  void add_node(std::uint32_t first, std::uint32_t last, int depth, Float3& low, Float3& high);

  /// Returns the mask of the boxes that contain the point.
  static unsigned boxes_at(const Node& node, const Float3& point);
  /// Returns the mask of the photons of a leaf whose spheres contain the point. The sphere of a
  /// photon has the center and the radius of its disk.
  unsigned spheres_at(const Child& leaf, const Float3& point) const;

  Vec3 origin_;
  std::vector<StoredPhoton> photons_;
  /// Position x, y, z and squared radius of all photons, once more, so that eight photons are
  /// tested at once. At the end there are kWidth more, so that eight can be loaded from any photon.
  std::array<std::vector<float>, 4> disks_;
  std::vector<Node> nodes_;  ///< the first is the root
};

/// Returns the density of a photon's power at a point, in 1 / area: Epanechnikov's kernel over the
/// disk. It is 0 for points farther from the disk's plane than a quarter of the radius, and for
/// normals that differ by more than 60 degrees, because such points belong to other surfaces.
inline float density_at(const StoredPhoton& photon, const Float3& position, const Float3& normal) {
  const float x = position[0] - photon.position[0];
  const float y = position[1] - photon.position[1];
  const float z = position[2] - photon.position[2];
  const float distance2 = x * x + y * y + z * z;
  const float radius2 = photon.radius * photon.radius;
  if (distance2 >= radius2) {
    return 0;
  }
  const Float3& up = photon.normal;
  const float height = x * up[0] + y * up[1] + z * up[2];
  const float cosine = normal[0] * up[0] + normal[1] * up[1] + normal[2] * up[2];
  if (height * height * 16 >= radius2 || cosine < 0.5f) {
    return 0;
  }
  // The projection of a tilted surface onto the disk is smaller by the cosine.
  constexpr auto kPeak = static_cast<float>(2 / kPi);
  return kPeak / radius2 * (1 - distance2 / radius2) * cosine;
}

inline unsigned PhotonMap::boxes_at(const Node& node, const Float3& point) {
  const auto inside = [&](std::size_t axis) {
    const Float8 at(point[axis]);
    return (Float8::load(node.bounds[axis].data()) <= at) &
           (at <= Float8::load(node.bounds[axis + 3].data()));
  };
  return (inside(0) & inside(1) & inside(2)).bits();
}

inline unsigned PhotonMap::spheres_at(const Child& leaf, const Float3& point) const {
  const Float8 x = Float8(point[0]) - Float8::load(&disks_[0][leaf.first]);
  const Float8 y = Float8(point[1]) - Float8::load(&disks_[1][leaf.first]);
  const Float8 z = Float8(point[2]) - Float8::load(&disks_[2][leaf.first]);
  const unsigned near = (x * x + y * y + z * z < Float8::load(&disks_[3][leaf.first])).bits();
  return near & ((1u << leaf.photons) - 1);
}

template <class Visit>
void PhotonMap::visit(const Vec3& position, const Vec3& normal, const Visit& visit) const {
  if (nodes_.empty()) {
    return;
  }
  const Float3 p = float3(position - origin_);
  const Float3 up = float3(normal);
  /// A node, and the mask of its boxes that contain the point and are not visited yet.
  struct Level {
    std::uint32_t node;
    unsigned left;
  };
  std::array<Level, kMaxLevels> levels;
  levels[0] = {0, boxes_at(nodes_[0], p)};
  for (std::size_t used = 1; used > 0;) {
    Level& level = levels[used - 1];
    if (level.left == 0) {
      --used;
      continue;
    }
    const Child& child = nodes_[level.node].children[std::countr_zero(level.left)];
    level.left &= level.left - 1;
    if (child.photons == 0) {
      levels[used++] = {child.first, boxes_at(nodes_[child.first], p)};
      continue;
    }
    for (unsigned near = spheres_at(child, p); near != 0; near &= near - 1) {
      const StoredPhoton& photon = photons_[child.first + std::countr_zero(near)];
      if (const float density = density_at(photon, p, up); density > 0) {
        visit(photon, density);
      }
    }
  }
}

}  // namespace bandsaw
