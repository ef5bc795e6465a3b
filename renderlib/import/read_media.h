#pragma once

// Media of a scene file, and what they are inside of.

#include <optional>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/field.h"
#include "renderlib/import/scene_draft.h"

namespace bandsaw {

/// All media, and the fog.
absl::Status read_media(const Field& root, const scene::Scene& from, SceneDraft& draft);

/// The medium called `name`, which is the value of `in`'s field `field`. INVALID_ARGUMENT: none is
/// called so.
absl::StatusOr<MediumId> find_medium(const Field& in, const std::string& field,
                                     const std::string& name, const SceneDraft& draft);

/// INVALID_ARGUMENT, about `in`'s field "interior": what is being read is a group.
absl::Status check_boundary_place(const Field& in, const SceneDraft& draft);

void add_boundary(const Sphere& sphere, MediumId inside, SceneDraft& draft);
/// A box from `low` to `high`.
void add_boundary(const Vec3& low, const Vec3& high, MediumId inside, SceneDraft& draft);
/// The placement of a mesh of the scene. INVALID_ARGUMENT, about `in`'s field "interior": the mesh
/// is open.
absl::Status add_boundary(const Field& in, const Instance& placed, MediumId inside,
                          SceneDraft& draft);

}  // namespace bandsaw
