// place() copies frames and instances to another place. A copied frame without a parent gets the
// frame of the place as its parent. A copied instance without a frame gets the frame of the place
// as its frame. Only these frames and instances are transformed by Place::to_frame, because all
// others move with one of these frames. Indices of frames are shifted, because the copied frames
// follow the frames that `to` already has.

#include "renderlib/import/draft/placements.h"

#include <utility>

namespace bandsaw {

FrameId add_frame(Frame frame, Placements& to) {
  to.frames.push_back(std::move(frame));
  return FrameId{static_cast<std::uint32_t>(to.frames.size() - 1)};
}

bool place(const Placements& what, const Place& at, std::optional<MaterialId> material,
           Placements& to) {
  const auto first = static_cast<std::uint32_t>(to.frames.size());
  const auto moved = [first](FrameId id) {
    return FrameId{first + static_cast<std::uint32_t>(id)};
  };
  for (Frame frame : what.frames) {
    if (frame.parent == kNoFrame) {
      frame.parent = at.frame;
      frame.placement = at.to_frame * frame.placement;
    } else {
      frame.parent = moved(frame.parent);
    }
    to.frames.push_back(std::move(frame));
  }
  for (Instance instance : what.instances) {
    if (instance.frame == kNoFrame) {
      instance.frame = at.frame;
      instance.to_world = at.to_frame * instance.to_world;
      if (!inverse(instance.to_world)) {
        return false;
      }
    } else {
      instance.frame = moved(instance.frame);
    }
    instance.material = material.value_or(instance.material);
    to.instances.push_back(instance);
  }
  return true;
}

}  // namespace bandsaw
