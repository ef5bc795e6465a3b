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

/// These functions return the boundary of the medium `inside`, which is an instance in
/// Media::boundaries (scene/media.h). It is a sphere, a box from `low` to `high`, or `mesh`, which
/// is an instance of a mesh of the scene. The caller adds it to the boundaries of the scene or of a
/// group (Placements).
/// The last function returns INVALID_ARGUMENT for `in`'s field "interior" if the mesh is open.
Instance boundary_of(const Sphere& sphere, MediumId inside, SceneDraft& draft);
Instance boundary_of(const Vec3& low, const Vec3& high, MediumId inside, SceneDraft& draft);
absl::StatusOr<Instance> boundary_of(const Field& in, const Instance& mesh, MediumId inside,
                                     SceneDraft& draft);

/// Places a boundary that boundary_of() returned. `placement` maps the boundary to the coordinates
/// of `to`, the scene or a group. If the medium inside has no grids, only the boundary's transform
/// is changed. If it has grids, they must move with the boundary (scene/media.h). So a frame (a
/// coordinate system, geometry/frame.h) with this placement is added to `to`, and the boundary is
/// put into it. The boundary MUST have no frame yet.
void place_boundary(const Transform& placement, Instance& boundary, const SceneDraft& draft,
                    Placements& to);

}  // namespace bandsaw
