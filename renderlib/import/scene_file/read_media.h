#pragma once

// Reads media of a scene file (fog, smoke, liquids), and makes their boundaries: the closed shapes
// that a medium fills.

#include <optional>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads all media, and the name of the fog. The fog is the medium outside of all boundaries.
/// Returns INVALID_ARGUMENT, with the name of the field, if a field is invalid.
absl::Status read_media(const Field& root, const scene::Scene& from, SceneDraft& draft);

/// Returns the medium with this name, which is the value of `in`'s field `field`. Returns
/// INVALID_ARGUMENT if there is none.
absl::StatusOr<MediumId> find_medium(const Field& in, const std::string& field,
                                     const std::string& name, const SceneDraft& draft);

/// These functions return the boundary of the medium `inside`: an instance of a mesh or a group in
/// Media::boundaries (scene/media.h). The caller adds this instance to a Placements. The boundary
/// is a sphere, a box from `low` to `high`, or `mesh`, which is an instance of a mesh of the scene.
/// The last function returns INVALID_ARGUMENT for `in`'s field "interior" if the mesh is open.
Instance boundary_of(const Sphere& sphere, MediumId inside, SceneDraft& draft);
Instance boundary_of(const Vec3& low, const Vec3& high, MediumId inside, SceneDraft& draft);
absl::StatusOr<Instance> boundary_of(const Field& in, const Instance& mesh, MediumId inside,
                                     SceneDraft& draft);

/// Places `boundary` at `placement` in the space of `to`. boundary_of() MUST have returned the
/// boundary, and the boundary MUST have no frame (a coordinate system, geometry/frame.h). If the
/// medium inside has grids, a frame with this placement is added to `to`, and the boundary is put
/// into this frame. So the grids move with the placement (scene/media.h). If the medium has no
/// grids, only the boundary's transform is changed.
void give_space(const Transform& placement, Instance& boundary, const SceneDraft& draft,
                Placements& to);

}  // namespace bandsaw
