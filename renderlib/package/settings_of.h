#pragma once

#include <cstdint>
#include <optional>

#include "renderlib/package/package.h"
#include "renderlib/render/settings.h"

namespace bandsaw {

/// What a package asks for, at this size in pixels. A width or height alone keeps the aspect ratio,
/// rounded to the nearest pixel. A side past kMaxSide is left for validate(RenderSettings).
RenderSettings settings_of(const PackageInfo& scene, std::optional<std::uint32_t> width,
                           std::optional<std::uint32_t> height);

}  // namespace bandsaw
