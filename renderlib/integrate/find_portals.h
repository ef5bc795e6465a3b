#pragma once

// Finds portals, which are openings through which the background lights a room (guiding/portals.h).
// A portal is a rectangle. Only few rays leave the scene, and most of them pass through a portal.

#include <cstdint>
#include <optional>

#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/guiding/portals.h"
#include "renderlib/integrate/preparation.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Traces paths from the camera, and returns the portals that fit the rays scattered by surfaces.
/// The result is a pure function of the scene and of the width and height of the image. If
/// `preparation` is stopped, returns std::nullopt. Otherwise adds the number of rays to `traced`.
std::optional<Portals> find_portals(const Scene& scene, const GuidingKey& key,
                                    const Preparation& preparation, std::uint64_t& traced);

}  // namespace bandsaw
