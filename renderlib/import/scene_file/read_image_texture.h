#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// The image that `in` stands for. INVALID_ARGUMENT: its file, or a field.
absl::StatusOr<TextureId> read_image_texture(const Field& in, const scene::ImageTexture& from,
                                             SceneDraft& draft);

/// `value` of an enum whose values are 0 to `last`.
template <class Ours>
absl::StatusOr<Ours> read_enum(const Field& in, const std::string& name, int value, int last) {
  if (value < 0 || value > last) {
    return in.error(name, "is none of the values that it can have");
  }
  return static_cast<Ours>(value);
}

}  // namespace bandsaw
