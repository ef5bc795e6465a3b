#pragma once

// Converts the media of Mitsuba scenes.

#include <array>
#include <map>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/mitsuba/conversion.h"
#include "renderlib/import/mitsuba/parameters.h"

namespace bandsaw::mitsuba {

class Media {
 public:
  /// Media are added to `scene`. Both MUST outlive this object.
  Media(scene::Scene& scene, Conversion& to) : scene_(scene), to_(to) {}

  /// Returns the name that `medium` has in the Bandsaw scene. Adds the medium if it is new.
  /// `to_world` is the placement of the shape around the medium: Mitsuba places grids in the world,
  /// but Bandsaw places them in the space of this shape. Fails for an unknown type of medium, for a
  /// wrong parameter and for a grid file that cannot be found; the message names file and line.
  absl::StatusOr<std::string> medium_of(const Object& medium, const Transform& to_world);

 private:
  scene::Scene& scene_;
  Conversion& to_;
  /// Names of the media that were made. The key is the medium with the placement of its shape, or
  /// with the identity if the medium has no grid.
  std::map<std::pair<const Object*, std::array<std::array<double, 4>, 3>>, std::string> known_;
  std::map<std::string, int> names_;  ///< media made for each id; "medium" stands for no id
};

}  // namespace bandsaw::mitsuba
