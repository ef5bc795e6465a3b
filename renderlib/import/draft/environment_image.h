#pragma once

// Environment maps from image files.

#include <string>

#include "absl/status/statusor.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/light/environment.h"

namespace bandsaw {

/// Clamps texels of a float image to [0, 1e30], because light must be finite: NaN and negative
/// numbers become 0, larger ones 1e30. Returns the number of changed texels.
std::size_t repair_light(ImageTexture& image);

/// Adds the image of a file to the draft's textures. Repaired texels cause a warning that begins
/// with `name`. Returns INVALID_ARGUMENT if it is not an image.
absl::StatusOr<TextureId> add_environment_image(const std::string& bytes, const std::string& name,
                                                SceneDraft& draft);

}  // namespace bandsaw
