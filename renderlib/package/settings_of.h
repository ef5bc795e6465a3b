#pragma once

#include <cstdint>
#include <optional>

#include "renderlib/package/package.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

/// Returns the render settings of a package, at the given size in pixels. Without `width` and
/// `height` the size is that of the package. If only one side is given, the missing side follows
/// from the aspect ratio of the package and is rounded to the nearest pixel. A side of the result
/// may be above kMaxSide; validate(RenderSettings) refuses such settings.
RenderSettings settings_of(const PackageInfo& scene, std::optional<std::uint32_t> width,
                           std::optional<std::uint32_t> height);

}  // namespace bandsaw
