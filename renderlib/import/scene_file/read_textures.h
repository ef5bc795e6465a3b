#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads the named textures of the scene file into SceneDraft::named_textures; MUST be called
/// before materials are read.
absl::Status read_textures(const Field& root, const scene::Scene& from, SceneDraft& draft);

/// Reads the texture of `in`, which is defined there or referred to by name. Returns
/// INVALID_ARGUMENT, with the field's name, if a channel is above `most` anywhere.
absl::StatusOr<TextureId> read_texture(const Field& in, const scene::Texture& from, float most,
                                       SceneDraft& draft);

}  // namespace bandsaw
