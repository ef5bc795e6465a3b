#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

using ModelList = google::protobuf::RepeatedPtrField<scene::Model>;

/// Reads the models that a scene file names, those of the scene or of a group, which is `parent`,
/// into SceneDraft::placed, and their cameras into SceneDraft::cameras. Each file is read once. The
/// scene's materials MUST have been read.
absl::Status read_models(const Field& parent, const ModelList& models, SceneDraft& draft);

}  // namespace bandsaw
