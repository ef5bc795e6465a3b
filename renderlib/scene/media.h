#pragma once

// Where the media of a scene are: inside closed shapes, and around everything.
//
// Which medium a point is in depends on the point alone, not on how light came there: of all
// closed shapes that contain it the medium with the highest number is there, the one that the scene
// names last; where there is none, the fog; without fog, nothing.

#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/base/ids.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/medium/medium.h"

namespace bandsaw {

struct Media {
  std::vector<Medium> media;
  /// Spheres, and placements of closed meshes and of groups of one sphere, nothing else. Their
  /// `material` is no material: it is the medium inside, an index into `media`. What is seen of
  /// them lies in the scene's own geometry as well, or nothing is: then the boundary is invisible.
  /// Placements change where a medium is, not how dense: coefficients are per unit of the world.
  Geometry boundaries;
  std::optional<MediumId> fog;  ///< without end; MUST NOT be is_endless_glow

  bool has_boundaries() const {
    return !boundaries.spheres.empty() || !boundaries.instances.empty();
  }
};

/// The medium inside of a boundary.
constexpr MediumId medium_in(MaterialId of_boundary) {
  return MediumId{static_cast<std::uint32_t>(of_boundary)};
}
constexpr MaterialId filled_with(MediumId medium) {
  return MaterialId{static_cast<std::uint32_t>(medium)};
}

/// The unit cube [0, 1]^3, normals to the outside: a box is a placement of it.
Mesh unit_cube();

/// The sphere of radius 1 around 0, as a group: any sphere is a placement of it.
Shapes unit_ball();

/// INVALID_ARGUMENT: "media[1].g: must be in [-0.999, 0.999], is 2",
/// "boundaries.meshes[0]: must be closed, has 4 open edges".
absl::Status validate(const Media& media);

}  // namespace bandsaw
