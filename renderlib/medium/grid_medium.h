#pragma once

// A medium that varies in space, prepared for tracking (tracking.h): its grids, and the bounds of
// its density in regions of space. In general a region is one brick of a grid, 8 x 8 x 8 cells.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/math/rgb.h"
#include "renderlib/math/transform.h"
#include "renderlib/math/vec.h"
#include "renderlib/medium/blackbody.h"
#include "renderlib/medium/medium.h"
#include "renderlib/medium/volume_grid.h"

namespace bandsaw {

/// A part of space in which the density lies between two bounds, in every channel.
struct Region {
  float least = 0;
  float most = 0;
  bool emits = false;  ///< false: the medium emits nowhere in the region
};

/// The regions of a medium: a block of cubes, and everything around it. The space of the regions is
/// the cell space (volume_grid.h) of the density grid, or of another grid if the medium has no
/// density grid.
struct Regions {
  Transform from_medium;  ///< from the medium's space to that of the regions
  /// The block, in the space of the regions. The last cube along an axis may extend beyond `high`.
  Vec3 low;
  Vec3 high;
  double side = kBrickSide;  ///< side of a cube
  std::array<std::uint32_t, 3> count = {};
  std::vector<Region> regions;  ///< x fastest
  Region around;                ///< outside of the block
};

/// Coefficients at a point, per scene unit and channel. They are not Rgb, because a product of a
/// density and a coefficient may be larger than the largest float.
struct Coefficients {
  std::array<double, 3> extinction{};
  std::array<double, 3> scattering{};
};

/// A medium and readers of its grids. Points are given in the medium's space (scene/media.h).
class GridMedium {
 public:
  /// `medium` refers to entries of `grids`. The medium and the grids MUST be valid, and the grids
  /// MUST outlive this object.
  GridMedium(const Medium& medium, const std::vector<VolumeGrid>& grids);

  const Regions& regions() const { return regions_; }
  /// Returns the mean cosine of the phase function.
  double g() const { return g_; }
  /// Returns the extinction coefficients where the density is 1.
  const std::array<double, 3>& extinction() const { return extinction_; }
  /// Returns the largest channel of extinction().
  double max_extinction() const { return max_extinction_; }
  bool scatters() const { return scatters_; }
  bool emits() const { return emits_; }

  /// Returns the density at a point, by channel; `most` where the density is larger than `most`.
  std::array<double, 3> density(const Vec3& at, double most) const;
  /// Returns the coefficients at a point with this density.
  Coefficients coefficients(const Vec3& at, const std::array<double, 3>& density) const;
  /// Returns the emitted radiance per scene unit at a point with this density.
  std::array<double, 3> emission(const Vec3& at, const std::array<double, 3>& density) const;

 private:
  /// Reads a grid at points of the medium's space, and multiplies its numbers by `scale`.
  struct Lookup {
    GridReader reader;
    Transform from_medium;  ///< to the grid's cell space
    double scale;
    double value(const Vec3& at) const { return scale * reader.value(from_medium.point(at)); }
    std::array<double, 3> color(const Vec3& at) const;
  };
  using Channels = std::array<double, 3>;

  /// Returns the look-up of the grid that `use` names; std::nullopt if `use` names none.
  static std::optional<Lookup> lookup(const std::optional<GridUse>& use,
                                      const std::vector<VolumeGrid>& grids);
  /// Computes `regions_`.
  void find_regions(const MediumGrids& uses, const std::vector<VolumeGrid>& grids);

  Channels extinction_{};
  Channels scattering_{};
  Channels emission_{};
  double max_extinction_ = 0;
  double g_ = 0;
  bool scatters_ = false;
  bool emits_ = false;
  std::optional<Lookup> density_;
  std::optional<Lookup> albedo_;
  std::optional<Lookup> emitted_;
  std::optional<Lookup> temperature_;
  double temperature_offset_ = 0;
  std::optional<BlackbodyTable> blackbody_;
  Regions regions_;
};

}  // namespace bandsaw
