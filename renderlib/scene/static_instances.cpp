// Instances are placed in frames, which are coordinate systems that may move. A frame may have a
// parent frame. An instance is static if its frame and all frames above have constant transforms
// throughout the shutter interval.

#include "renderlib/scene/static_instances.h"

#include <algorithm>

#include "renderlib/geometry/placement.h"

namespace bandsaw {
namespace {

/// Returns true if the frame's own transform, relative to its parent, is constant in the interval.
bool is_constant(const Frame& frame, const Interval& interval) {
  const Transform at_open = motion_at(frame, interval.open);
  const bool same_at_close = motion_at(frame, interval.close) == at_open;
  return same_at_close && std::all_of(frame.keys.begin(), frame.keys.end(), [&](const Key& key) {
           const bool within = key.time > interval.open && key.time < interval.close;
           return !within || key.at == at_open;
         });
}

}  // namespace

void make_static(Geometry& geometry) {
  const Interval& interval = geometry.shutter;
  std::vector<bool> still;
  for (const Frame& frame : geometry.frames) {
    // A parent precedes its children, so `still` has an entry for the parent.
    const bool parent_is_still = frame.parent == kNoFrame || still[index_of(frame.parent)];
    still.push_back(parent_is_still &&
                    (interval.open == interval.close || is_constant(frame, interval)));
  }
  for (Instance& instance : geometry.instances) {
    if (instance.frame != kNoFrame && still[index_of(instance.frame)]) {
      instance.to_world = to_world_at(geometry, instance, interval.open);
      instance.frame = kNoFrame;
    }
  }
}

bool moves(const Geometry& geometry) {
  return geometry.shutter.open != geometry.shutter.close &&
         std::any_of(geometry.instances.begin(), geometry.instances.end(),
                     [&](const Instance& instance) { return moves(geometry, instance); });
}

}  // namespace bandsaw
