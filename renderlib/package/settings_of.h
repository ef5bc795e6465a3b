#pragma once

#include <cstdint>
#include <optional>

#include "renderlib/package/package.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

/// Returns the render settings of a package, at the given size in pixels. If only a width or only a
/// height is given, the aspect ratio is kept, rounded to the nearest pixel.
/// validate(RenderSettings) refuses sides above kMaxSide.
RenderSettings settings_of(const PackageInfo& scene, std::optional<std::uint32_t> width,
                           std::optional<std::uint32_t> height);

}  // namespace bandsaw
