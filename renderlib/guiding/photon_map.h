#pragma once

// A map of photons on surfaces: the irradiance at a point is estimated from the photons around it
// (Jensen 1996, "Global Illumination Using Photon Maps"). Each photon spreads its power over a disk
// of its own, which is small where photons are dense (the sample-point adaptive kernel of Breiman,
// Meisel and Purcell 1977, "Variable Kernel Estimates of Multivariate Densities"). So the sum of
// the power is kept whatever the radii are, and bright lines stay narrow.

#include <cstdint>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "renderlib/base/pool.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/float3.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// A photon that arrived at a surface.
struct StoredPhoton {
  Float3 position{};        ///< relative to PhotonMap::origin
  float radius = 0;         ///< of its disk, scene units; set by PhotonMap
  Float3 normal{};          ///< geometric normal of the surface, unit, on the side of arrival
  std::uint32_t chain = 0;  ///< number of scatterings between the light and this surface
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
    return photons_.size() * sizeof(StoredPhoton) + nodes_.size() * sizeof(Node);
  }

 private:
  /// A node of a binary tree in depth-first order: its first child follows it.
  struct Node {
    Float3 low;  ///< box of the disks
    Float3 high;
    std::uint32_t next = 0;   ///< the node after all descendants
    std::uint32_t first = 0;  ///< photons [first, last) of a leaf; empty for other nodes
    std::uint32_t last = 0;
  };
  /// Makes the nodes of photons [first, last), which it sorts.
  void split(std::uint32_t first, std::uint32_t last, int depth);
  /// Computes the boxes of all nodes.
  void set_boxes();

  Vec3 origin_;
  std::vector<StoredPhoton> photons_;
  std::vector<Node> nodes_;
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

template <class Visit>
void PhotonMap::visit(const Vec3& position, const Vec3& normal, const Visit& visit) const {
  const Float3 p = float3(position - origin_);
  const Float3 up = float3(normal);
  const auto count = static_cast<std::uint32_t>(nodes_.size());
  for (std::uint32_t i = 0; i < count;) {
    const Node& node = nodes_[i];
    const bool inside = p[0] >= node.low[0] && p[0] <= node.high[0] && p[1] >= node.low[1] &&
                        p[1] <= node.high[1] && p[2] >= node.low[2] && p[2] <= node.high[2];
    if (!inside) {
      i = node.next;
      continue;
    }
    for (std::uint32_t at = node.first; at < node.last; ++at) {
      if (const float density = density_at(photons_[at], p, up); density > 0) {
        visit(photons_[at], density);
      }
    }
    ++i;
  }
}

}  // namespace bandsaw
