#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

using ShapeList = google::protobuf::RepeatedPtrField<scene::Shape>;

/// Reads all shapes of `parent`, which is the scene or a group, into SceneDraft::shapes. Moving
/// shapes become placements in SceneDraft::placed. The boundaries of media inside of shapes also
/// become placements there, except for resting spheres of the scene. Materials, media and shutter
/// MUST have been read. Returns INVALID_ARGUMENT, with the name of the field, if a field is
/// invalid.
absl::Status read_shapes(const Field& parent, const ShapeList& shapes, SceneDraft& draft);

}  // namespace bandsaw
