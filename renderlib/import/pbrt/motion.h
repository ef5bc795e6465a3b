#pragma once

// Motion between two transformations.

#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {

/// Scale, then rotation, then translation.
struct Pose {
  Vec3 scale{1, 1, 1};
  Vec3 axis{0, 0, 1};
  double degrees = 0;
  Vec3 translate;
};

/// Returns the pose whose transformation is `t`; std::nullopt if `t` shears.
std::optional<Pose> pose_of(const Transform& t);

/// Adds a group that things are placed in, before the group that ObjectBegin has opened, and sets
/// its name.
scene::Group& add_helper_group(Builder& builder, std::string& name);

/// Adds a model or an instance to the open group or to the scene, placed by its matrix, or by keys
/// if it moves. If the motion changes the shear or mirrors the model, the model stays at the
/// first transformation, with a warning.
void add_placed(const Place& place, const Transforms& transforms, scene::Model model,
                Builder& builder);
void add_placed(const Place& place, const Transforms& transforms, scene::Instance instance,
                Builder& builder);

}  // namespace bandsaw::pbrt
