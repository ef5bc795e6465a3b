#pragma once

// An object of type Placements describes one space: the scene or a group. It holds instances of
// meshes and groups, and the moving coordinate systems (Frame) of the space. An import collects
// these instances and frames before it adds them to the scene's geometry.

#include <optional>
#include <vector>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

struct Placements {
  std::vector<Frame> frames;
  std::vector<Instance> instances;  ///< Instance::frame is an index in `frames`, or kNoFrame
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

/// Where an instance is in the space of a Placements.
struct Place {
  /// Transform from the instance to `frame`, or to the space itself if `frame` is kNoFrame.
  Transform to_frame;
  FrameId frame = kNoFrame;
};

/// Appends the frame and returns its index in `to`.
FrameId add_frame(Frame frame, Placements& to);

/// Copies all frames and instances of `what` to `to`, at the place `at` in the space of `to`. If
/// `material` is set, it replaces the materials of the copied instances. Returns false if the
/// transform of a copied instance would be singular. Then only some of the instances have been
/// added to `to`.
bool place(const Placements& what, const Place& at, std::optional<MaterialId> material,
           Placements& to);

}  // namespace bandsaw
