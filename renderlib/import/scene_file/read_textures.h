#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads the named textures of the scene file into SceneDraft::named_textures. MUST be called
/// before materials are read. Returns INVALID_ARGUMENT, with the name of the field, if a field is
/// invalid.
absl::Status read_textures(const Field& root, const scene::Scene& from, SceneDraft& draft);

/// Reads the texture that the message `from` defines or refers to by name. `in` is the field that
/// holds the message. Returns INVALID_ARGUMENT,
/// with the name of the field, if a field is invalid or if a channel of the texture is above `most`
/// anywhere.
absl::StatusOr<TextureId> read_texture(const Field& in, const scene::Texture& from, float most,
                                       SceneDraft& draft);

}  // namespace bandsaw
