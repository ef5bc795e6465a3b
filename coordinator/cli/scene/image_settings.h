#pragma once

// Makes the render settings of an image: those of the scene, overridden by the command line.

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "renderlib/package/package.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {

/// Returns the settings of `scene`, in which the options that are given replace the scene's values.
/// If only one of width and height is given, the other one is computed from the scene's aspect
/// ratio and rounded to the nearest pixel. The seed of a frame is the sum of --seed and the number
/// of the frame, unless --fixed-seed is given. INVALID_ARGUMENT: the settings are out of range,
/// such as an image that is too large.
absl::StatusOr<RenderSettings> image_settings(const ImageOptions& options,
                                              const PackageInfo& scene);

}  // namespace bandsaw::coordinator
