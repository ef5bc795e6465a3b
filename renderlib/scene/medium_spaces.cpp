// A medium may vary in space. Such a medium moves with its boundary (the closed shape that it
// fills): it varies in the space of the boundary's frame (a coordinate system that may move). This
// file stores the frame of each
// boundary before static boundaries lose their frames (static_instances.h), and computes the map
// from the world to the frame. The map of a static boundary is computed once. The map of a boundary
// that moves is computed anew for each time.

#include "renderlib/scene/medium_spaces.h"

#include "renderlib/geometry/frame.h"

namespace bandsaw {
namespace {

/// Returns the map from the world to a frame. Validation has checked that keys are regular. If the
/// frame is singular at a time between two keys, returns the identity.
Transform to_frame(const Geometry& boundaries, FrameId frame, double time) {
  return inverse(frame_at(boundaries.frames, frame, time)).value_or(Transform{});
}

}  // namespace

MediumSpaces::MediumSpaces(const Geometry& boundaries) {
  for (const Instance& instance : boundaries.instances) {
    frames_.push_back(instance.frame);
  }
}

void MediumSpaces::prepare(const Geometry& boundaries, double time) {
  still_.resize(frames_.size());
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (frames_[i] != kNoFrame && boundaries.instances[i].frame == kNoFrame) {
      still_[i] = to_frame(boundaries, frames_[i], time);
    }
  }
}

Transform MediumSpaces::to_medium(const Geometry& boundaries, std::uint32_t boundary,
                                  double time) const {
  if (boundary == 0) {
    return {};
  }
  const FrameId moves_with = boundaries.instances[boundary - 1].frame;
  return moves_with == kNoFrame ? still_[boundary - 1] : to_frame(boundaries, moves_with, time);
}

}  // namespace bandsaw
