#pragma once

// The last step of a conversion: converts media that open surfaces bound, and orders all media.

#include <string>

#include "absl/status/status.h"
#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {

/// Fills the box around the scene with each medium that an open surface bounds, except the camera's
/// medium `of_camera`, which becomes the fog of the scene. If the scene needs it, adds the vacuum
/// (kVacuum), which is an empty medium. Orders the media, because where media overlap, the later
/// one replaces the earlier one.
absl::Status finish_media(const std::string& of_camera, Builder& builder);

}  // namespace bandsaw::pbrt
