#pragma once

// The parameters of a request that submits a scene.

#include "absl/status/statusor.h"
#include "coordinator/web/http.h"
#include "coordinator/web/scenes.h"

namespace bandsaw::coordinator {

/// Reads `width` (pixels), `title` (the job's name, cleaned and cut by clean_text), and `scene`
/// (the name of the scene file in a zip). Reads one of `error` (0.02: two percent), `time`
/// (seconds) and `samples` (a pixel), which ends the job; without any of them, the job has 64
/// samples. INVALID_ARGUMENT: a parameter is out of range; the message names it.
absl::StatusOr<SceneRequest> scene_request(const HttpRequest& request);

}  // namespace bandsaw::coordinator
