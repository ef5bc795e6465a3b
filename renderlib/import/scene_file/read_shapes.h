#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

using ShapeList = google::protobuf::RepeatedPtrField<scene::Shape>;

/// Reads all shapes of `parent`, which is the scene or a group, into SceneDraft::shapes. Moving
/// shapes become placements in SceneDraft::placed. If a shape is filled with a medium, the boundary
/// of the medium becomes a placement in SceneDraft::placed too. The exception is a sphere that is
/// in no group and does not move: its boundary is stored as a sphere in Media::boundaries.
/// Materials, media and shutter MUST have been read. Returns INVALID_ARGUMENT, with the name of the
/// field, if a field is invalid.
absl::Status read_shapes(const Field& parent, const ShapeList& shapes, SceneDraft& draft);

}  // namespace bandsaw
