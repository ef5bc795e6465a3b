#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

using ModelList = google::protobuf::RepeatedPtrField<scene::Model>;

/// All model entries of the scene or of a group, into SceneDraft::placed; what cameras they bring,
/// into SceneDraft::cameras. A file that is named twice is read once. The scene's materials have
/// been read.
absl::Status read_models(const Field& parent, const ModelList& models, SceneDraft& draft);

}  // namespace bandsaw
