#pragma once

// Reads the principled materials of a scene file, which follow Disney's model.

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// These functions read a material of kind `principled` or `thin_principled`, whose message is
/// `in`. They return INVALID_ARGUMENT, with the name of the field, if a field is invalid.
absl::StatusOr<Material> read_principled(const Field& in, const scene::Principled& from,
                                         SceneDraft& draft);
absl::StatusOr<Material> read_thin_principled(const Field& in, const scene::ThinPrincipled& from,
                                              SceneDraft& draft);

}  // namespace bandsaw
