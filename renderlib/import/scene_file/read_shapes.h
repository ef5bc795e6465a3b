#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

using ShapeList = google::protobuf::RepeatedPtrField<scene::Shape>;

/// Reads all shapes of the scene or of a group into SceneDraft::shapes and SceneDraft::placed.
/// Materials and shutter MUST have been read.
absl::Status read_shapes(const Field& parent, const ShapeList& shapes, SceneDraft& draft);

}  // namespace bandsaw
