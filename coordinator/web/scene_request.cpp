// Reads and checks the parameters of an HTTP request that submits a scene: the width, the stop
// rule, the title and the name of the scene file.

#include "coordinator/web/scene_request.h"

#include "absl/strings/numbers.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {

absl::StatusOr<SceneRequest> scene_request(const HttpRequest& request) {
  SceneRequest wanted;
  wanted.inside = request.parameter("scene");
  wanted.title = clean_text(request.parameter("title"), wire::kJobNameBytes);
  const std::string width = request.parameter("width");
  if (!width.empty() && (!absl::SimpleAtoi(width, &wanted.width) || wanted.width > kMaxSide)) {
    return absl::InvalidArgumentError("width: must be a number of pixels");
  }
  if (const std::string error = request.parameter("error"); !error.empty()) {
    StopAtError stop;
    if (!absl::SimpleAtod(error, &stop.relative_rmse) || !(stop.relative_rmse > 0) ||
        stop.relative_rmse > 1) {
      return absl::InvalidArgumentError("error: must be in (0, 1]");
    }
    wanted.stop = stop;
  } else if (const std::string time = request.parameter("time"); !time.empty()) {
    StopAtTime stop;
    if (!absl::SimpleAtod(time, &stop.seconds) || !(stop.seconds > 0) || stop.seconds > 1e9) {
      return absl::InvalidArgumentError("time: must be a number of seconds");
    }
    wanted.stop = stop;
  } else if (const std::string text = request.parameter("samples"); !text.empty()) {
    StopAtSamples stop;
    if (!absl::SimpleAtoi(text, &stop.samples) || stop.samples < 1 || stop.samples > kMaxSamples) {
      return absl::InvalidArgumentError("samples: must be a number of samples a pixel");
    }
    wanted.stop = stop;
  }
  return wanted;
}

}  // namespace bandsaw::coordinator
