#pragma once

// The parameters of a request that submits a scene.

#include "absl/status/statusor.h"
#include "coordinator/web/http.h"
#include "coordinator/web/scenes.h"

namespace bandsaw::coordinator {

/// Reads the parameters of the request: `width` (pixels), `title` (the job's name; clean_text()
/// cuts it and replaces control characters), and `scene` (the name of the scene file in a zip). One
/// of the parameters `error` (0.02 means two percent), `time` (seconds) or `samples` (number for
/// each pixel) determines when the job ends. Without any of these three, the job renders 64 samples
/// for each pixel. INVALID_ARGUMENT: a parameter is out of range; the message names the parameter.
absl::StatusOr<SceneRequest> scene_request(const HttpRequest& request);

}  // namespace bandsaw::coordinator
