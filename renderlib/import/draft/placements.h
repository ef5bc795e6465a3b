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

/// What is in one space: what is seen, and the closed shapes that media fill, which are instances
/// of Media::boundaries (scene/media.h).
struct Contents {
  Placements seen;
  Placements filled;

  std::size_t size() const { return seen.instances.size() + filled.instances.size(); }
};

/// More placements than this are refused: each travels in the manifest.
inline constexpr std::size_t kMaxPlacements = 500'000;

/// Where something is put: at `to_frame` in a frame of `to`, or in its space.
struct Place {
  Transform to_frame;
  FrameId frame = kNoFrame;
};

FrameId add_frame(Frame frame, Placements& to);

/// Adds all of `what` to `to` at a place; `material` replaces its own. False: a placement would be
/// singular.
bool place(const Placements& what, const Place& at, std::optional<MaterialId> material,
           Placements& to);

}  // namespace bandsaw
