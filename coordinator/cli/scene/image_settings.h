#pragma once

// What is rendered: the scene's wishes, and what the command line changed.

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "renderlib/package/package.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {

/// A width or height alone keeps the scene's aspect ratio, rounded to the nearest pixel.
/// INVALID_ARGUMENT: too large.
absl::StatusOr<RenderSettings> image_settings(const ImageOptions& options,
                                              const PackageInfo& scene);

}  // namespace bandsaw::coordinator
