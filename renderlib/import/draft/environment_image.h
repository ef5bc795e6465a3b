#pragma once

// Image files as light all around a scene.

#include <string>

#include "absl/status/statusor.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/light/environment.h"

namespace bandsaw {

/// Brings texels of a float image into [0, 1e30]: NaN and negative numbers become 0, larger ones
/// the largest that is not. Returns how many were altered. Light must be finite.
std::size_t repair_light(ImageTexture& image);

/// Adds the image of a file to the draft's textures. What was repaired is a warning that begins
/// with `name`. INVALID_ARGUMENT: not an image.
absl::StatusOr<TextureId> add_environment_image(const std::string& bytes, const std::string& name,
                                                SceneDraft& draft);

}  // namespace bandsaw
