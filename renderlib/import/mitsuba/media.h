#pragma once

// Participating media of Mitsuba scenes.

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

  /// Returns the name of a medium of ours, made if it is new. Grids are placed in the world, but
  /// those of ours in the space of the shape, whose placement is `to_world`.
  absl::StatusOr<std::string> medium_of(const Object& medium, const Transform& to_world);

 private:
  scene::Scene& scene_;
  Conversion& to_;
  std::map<std::pair<const Object*, std::array<std::array<double, 4>, 3>>, std::string> known_;
  std::map<std::string, int> names_;
};

}  // namespace bandsaw::mitsuba
