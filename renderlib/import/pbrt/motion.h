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

/// Sets the keys of a model or instance that moves from the first transformation to the second. If
/// one of them shears, it stands at the first, with a warning.
void add_keys(const Transforms& transforms, const Place& place, scene::Model& to, Builder& builder);
void add_keys(const Transforms& transforms, const Place& place, scene::Instance& to,
              Builder& builder);

/// Places an instance by its matrix, or by keys if it moves.
void place_instance(const Place& place, const Transforms& transforms, scene::Instance& to,
                    Builder& builder);

}  // namespace bandsaw::pbrt
