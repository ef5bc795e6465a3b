#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

using ModelList = google::protobuf::RepeatedPtrField<scene::Model>;

/// Reads the models of `parent`, which is a scene or a group of it, into SceneDraft::placed, and
/// their cameras into SceneDraft::cameras. Each file is read once. The scene's materials MUST have
/// been read.
absl::Status read_models(const Field& parent, const ModelList& models, SceneDraft& draft);

}  // namespace bandsaw
