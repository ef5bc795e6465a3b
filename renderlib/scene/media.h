#pragma once

// Media of a scene and the regions they fill: closed shapes, which are called boundaries, and
// everything around them.
//
// The medium at a point depends on the point alone, not on the path of the light. If several
// boundaries contain the point, the medium with the highest number counts, i.e. the medium that the
// scene names last. Outside of all boundaries the medium is the fog; without fog there is none.
//
// A medium may vary in space as given by grids (medium/medium.h). The grids lie in the space of the
// medium, which moves with the boundary. It is the space of the boundary's frame
// (geometry/frame.h), or world space if the boundary has no frame. So several boundaries may
// contain the same medium, each at its own place. Where boundaries of the same medium overlap, the
// boundary with the highest number counts. In this order, spheres outside of groups come before all
// instances.

#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/base/ids.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/medium/medium.h"
#include "renderlib/medium/volume_grid.h"

namespace bandsaw {

/// The media, the grids by which they vary, and where they are.
struct Media {
  std::vector<Medium> media;
  std::vector<VolumeGrid> grids;  ///< MediumGrids refers to them
  /// Spheres, and instances of closed meshes and of groups of one sphere; nothing else. Their
  /// `material` is not a material but the medium inside, an index into `media`. If a boundary is
  /// visible, the scene's own geometry contains it as well; otherwise it is invisible. Placements
  /// change the region of a medium, not its density: coefficients are per unit of world space.
  Geometry boundaries;
  /// The medium outside of all boundaries, which has no end. MUST NOT have grids. MUST NOT emit in
  /// a channel in which it neither absorbs nor scatters (is_endless_glow), because it would be
  /// infinitely bright.
  std::optional<MediumId> fog;

  bool has_boundaries() const {
    return !boundaries.spheres.empty() || !boundaries.instances.empty();
  }
};

/// Converts between the medium inside a boundary and the boundary's `material`.
constexpr MediumId medium_in(MaterialId of_boundary) {
  return MediumId{static_cast<std::uint32_t>(of_boundary)};
}
constexpr MaterialId filled_with(MediumId medium) {
  return MaterialId{static_cast<std::uint32_t>(medium)};
}

/// Returns the unit cube [0, 1]^3 with outward normals; a box is an instance of it.
Mesh unit_cube();

/// Returns the sphere of radius 1 around the origin, as a group; a sphere is an instance of it.
Shapes unit_ball();

/// Returns INVALID_ARGUMENT if something is wrong, such as "media[1].g: must be in [-0.999, 0.999],
/// is 2" or "boundaries.meshes[0]: must be closed, has 4 open edges".
absl::Status validate(const Media& media);

}  // namespace bandsaw
