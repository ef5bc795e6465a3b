#pragma once

// Reads environment maps, which are images of the light from all directions, from image files.

#include <string>

#include "absl/status/statusor.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/light/environment.h"

namespace bandsaw {

/// Repairs the numbers of a float image that are not in [0, 1e30], because light must be finite.
/// Larger numbers become the largest valid number of the image; negative numbers and NaN become 0.
/// Returns how many numbers were changed.
std::size_t repair_light(ImageTexture& image);

/// Adds the image of a file to the textures of the draft, the scene that is being read. Repaired
/// numbers cause a warning. The errors are those of decode_image(). Warnings and errors begin with
/// `name`.
absl::StatusOr<TextureId> add_environment_image(const std::string& bytes, const std::string& name,
                                                SceneDraft& draft);

}  // namespace bandsaw
