#pragma once

// What is placed in one space, the scene or a group, before it is in the scene's geometry.

#include <optional>
#include <vector>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

struct Placements {
  std::vector<Frame> frames;
  std::vector<Instance> instances;  ///< their frames are those above
};

/// More placements than this are refused: each travels in the manifest.
inline constexpr std::size_t kMostPlacements = 500'000;

/// Where something is put: at `to_frame` in a frame of `to`, or in its space.
struct Place {
  Transform to_frame;
  FrameId frame = kNoFrame;
};

/// Adds all of `what` to `to` at a place; `material` replaces its own. False: a placement would be
/// singular.
bool place(const Placements& what, const Place& at, std::optional<MaterialId> material,
           Placements& to);

}  // namespace bandsaw
