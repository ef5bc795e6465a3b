#pragma once

// Places models and instances in our scene. If pbrt moves them from one transformation to another,
// they get two keys, which are poses at given times.

#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {

/// A transformation without shear: scale, then rotation, then translation.
struct Pose {
  Vec3 scale{1, 1, 1};
  Vec3 axis{0, 0, 1};
  double degrees = 0;
  Vec3 translate;
};

/// Returns the pose whose transformation is `t`. Returns std::nullopt if `t` has a shear, or if it
/// scales an axis to 0.
std::optional<Pose> pose_of(const Transform& t);

/// Adds an empty group to our scene and sets `name` to its name. If ObjectBegin has opened a group,
/// the new group comes before the open group, because instances refer only to earlier groups.
scene::Group& add_helper_group(Builder& builder, std::string& name);

/// Adds a model or an instance to the open group, or to the scene if no group is open. It is placed
/// by a matrix, or by keys if the two transformations differ. If the motion changes the shear,
/// mirrors the object, or has no duration, the model or instance stays at the first transformation,
/// with a warning.
void add_placed(const Place& place, const Transforms& transforms, scene::Model model,
                Builder& builder);
void add_placed(const Place& place, const Transforms& transforms, scene::Instance instance,
                Builder& builder);

}  // namespace bandsaw::pbrt
