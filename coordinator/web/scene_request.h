#pragma once

// The parameters of a request that submits a scene.

#include "absl/status/statusor.h"
#include "coordinator/web/http.h"
#include "coordinator/web/scenes.h"

namespace bandsaw::coordinator {

/// Reads `width` (pixels), `title` (the job's name, cleaned and cut as by clean_text), `scene` (the
/// scene file in a zip), and one of `samples` (a pixel), `error` (0.02: two percent), `time`
/// (seconds); none of these: 64 samples.
/// INVALID_ARGUMENT: a parameter is out of range; the message names it.
absl::StatusOr<SceneRequest> scene_request(const HttpRequest& request);

}  // namespace bandsaw::coordinator
