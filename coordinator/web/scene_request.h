#pragma once

// The parameters of a request that submits a scene.

#include "absl/status/statusor.h"
#include "coordinator/web/http.h"
#include "coordinator/web/scenes.h"

namespace bandsaw::coordinator {

/// Reads `width` (pixels), `title` (the job's name, cleaned and cut by clean_text), and `scene`
/// (the name of the scene file in a zip). `error` (0.02 means two percent), `time` (seconds) or
/// `samples` (number for each pixel) determines when the job ends. Without any of these three, the
/// job renders 64 samples for each pixel. INVALID_ARGUMENT: a parameter is out of range; the
/// message names it.
absl::StatusOr<SceneRequest> scene_request(const HttpRequest& request);

}  // namespace bandsaw::coordinator
