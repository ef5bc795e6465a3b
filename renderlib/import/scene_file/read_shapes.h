#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

using ShapeList = google::protobuf::RepeatedPtrField<scene::Shape>;

/// Reads all shapes of the scene or of a group, which is `parent`, into SceneDraft::shapes. Moving
/// shapes become placements in SceneDraft::placed, and so do the boundaries of media inside of
/// shapes, except for resting spheres of the scene. Materials and shutter MUST have been read.
/// Returns INVALID_ARGUMENT with the field's name.
absl::Status read_shapes(const Field& parent, const ShapeList& shapes, SceneDraft& draft);

}  // namespace bandsaw
