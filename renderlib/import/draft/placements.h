#pragma once

// A Placements holds instances of meshes and groups, and moving coordinate systems (Frame), in one
// space: the scene or a group. They are collected here before they are added to the scene's
// geometry.

#include <optional>
#include <vector>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

struct Placements {
  std::vector<Frame> frames;
  std::vector<Instance> instances;  ///< refer to the frames above
};

/// Contents of one space: visible instances, and the closed shapes that media fill, which are
/// instances of Media::boundaries (scene/media.h).
struct Contents {
  Placements seen;
  Placements filled;

  std::size_t size() const { return seen.instances.size() + filled.instances.size(); }
};

/// Maximum number of placements. There is a limit, because each placement is part of the manifest,
/// the message that describes a scene package.
inline constexpr std::size_t kMaxPlacements = 500'000;

/// Place of an instance in a Placements: the transform to the frame `frame` or, if that is
/// kNoFrame, to the space of the Placements.
struct Place {
  Transform to_frame;
  FrameId frame = kNoFrame;
};

/// Appends the frame and returns its index in `to`.
FrameId add_frame(Frame frame, Placements& to);

/// Adds all placements of `what` to `to` at a place; `material`, if set, replaces their materials.
/// Returns false if a placement would be singular; in that case only some of the placements have
/// been added to `to`.
bool place(const Placements& what, const Place& at, std::optional<MaterialId> material,
           Placements& to);

}  // namespace bandsaw
