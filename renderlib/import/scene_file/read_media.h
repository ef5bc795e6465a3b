#pragma once

// Reads media of a scene file (fog, smoke, liquids), and makes their boundaries: the closed shapes
// that a medium fills.

#include <optional>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads all media, and reads which of them is the fog, the medium that needs no boundary. Returns
/// INVALID_ARGUMENT with the field's name.
absl::Status read_media(const Field& root, const scene::Scene& from, SceneDraft& draft);

/// Returns the medium with this name, which is the value of `in`'s field `field`. Returns
/// INVALID_ARGUMENT if there is none.
absl::StatusOr<MediumId> find_medium(const Field& in, const std::string& field,
                                     const std::string& name, const SceneDraft& draft);

/// These functions return the boundary of the medium `inside` as an instance in Media::boundaries
/// (scene/media.h), which the caller places: a sphere, a box from `low` to `high`, or an instance
/// of a mesh of the scene. The last function returns INVALID_ARGUMENT for `in`'s field "interior"
/// if the mesh is open.
Instance boundary_of(const Sphere& sphere, MediumId inside, SceneDraft& draft);
Instance boundary_of(const Vec3& low, const Vec3& high, MediumId inside, SceneDraft& draft);
absl::StatusOr<Instance> boundary_of(const Field& in, const Instance& mesh, MediumId inside,
                                     SceneDraft& draft);

/// Places `boundary` at `placement` in the space of `to`. boundary_of() MUST have returned the
/// boundary, and it MUST have no frame. If its medium varies in space, the placement becomes a
/// frame of `to`: the medium then varies in the space in which the boundary is given, before it is
/// placed (scene/media.h).
void give_space(const Transform& placement, Instance& boundary, const SceneDraft& draft,
                Placements& to);

}  // namespace bandsaw
