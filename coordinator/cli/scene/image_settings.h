#pragma once

// Render settings: the scene's defaults, overridden by the command line.

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "renderlib/package/package.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {

/// If only a width or a height is given, the scene's aspect ratio is kept, rounded to the nearest
/// pixel. The seed of a frame is that of the options and its number, unless it is fixed.
/// INVALID_ARGUMENT: too large.
absl::StatusOr<RenderSettings> image_settings(const ImageOptions& options,
                                              const PackageInfo& scene);

}  // namespace bandsaw::coordinator
