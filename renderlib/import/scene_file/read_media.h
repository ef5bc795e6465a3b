#pragma once

// Media of a scene file, and what they are inside of.

#include <optional>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// All media, and the fog.
absl::Status read_media(const Field& root, const scene::Scene& from, SceneDraft& draft);

/// The medium called `name`, which is the value of `in`'s field `field`. INVALID_ARGUMENT: none is
/// called so.
absl::StatusOr<MediumId> find_medium(const Field& in, const std::string& field,
                                     const std::string& name, const SceneDraft& draft);

/// What the medium is inside of, as an instance of Media::boundaries: a sphere; a box from `low` to
/// `high`; a mesh of the scene. INVALID_ARGUMENT, about `in`'s field "interior": the mesh is open.
Instance boundary_of(const Sphere& sphere, MediumId inside, SceneDraft& draft);
Instance boundary_of(const Vec3& low, const Vec3& high, MediumId inside, SceneDraft& draft);
absl::StatusOr<Instance> boundary_of(const Field& in, const Instance& mesh, MediumId inside,
                                     SceneDraft& draft);

}  // namespace bandsaw
