#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// The images that `in`, a background, is made of; their texels are added to the draft.
/// INVALID_ARGUMENT: a field, or a file.
absl::StatusOr<Environment> read_environment(const Field& in, const scene::EnvironmentMap& from,
                                             SceneDraft& draft);
absl::StatusOr<Environment> read_cube_map(const Field& in, const scene::CubeMap& from,
                                          SceneDraft& draft);

}  // namespace bandsaw
