#pragma once

// Media that do not fill a closed shape, and the order of all media.

#include <string>

#include "absl/status/status.h"
#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {

/// Fills the box around the scene with each medium that open surfaces bound, except `of_camera`,
/// which is the fog, adds the vacuum if the scene needs it, and orders the media: later ones
/// replace earlier ones where they overlap.
absl::Status finish_media(const std::string& of_camera, Builder& builder);

}  // namespace bandsaw::pbrt
