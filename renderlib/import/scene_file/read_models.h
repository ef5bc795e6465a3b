#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

using ModelList = google::protobuf::RepeatedPtrField<scene::Model>;

/// Reads the models of `parent`, which is the scene or a group, into SceneDraft::placed. The
/// cameras of the models are added to SceneDraft::cameras, and their lights to the scene. Each file
/// is read once. The scene's materials MUST have been read.
absl::Status read_models(const Field& parent, const ModelList& models, SceneDraft& draft);

}  // namespace bandsaw
