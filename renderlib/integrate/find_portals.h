#pragma once

// Finds the openings through which the background lights a room (guiding/portals.h): the rectangles
// through which the few rays pass that leave the scene.

#include <vector>

#include "absl/types/span.h"
#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/guiding/portals.h"
#include "renderlib/integrate/preparation.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// A ray that a surface scattered.
struct ScatteredRay {
  Vec3 origin;
  Vec3 normal;           ///< of the surface, unit, on the side of the ray
  Vec3 direction;        ///< unit
  bool escapes = false;  ///< leaves the scene, to where the background is not black
};

/// Returns the portals through which most of the escaping rays pass and most of the others do not;
/// none if a large part of the rays escapes anyway, or if too few do to know. Depends on the rays
/// and their order only.
Portals portals_of(absl::Span<const ScatteredRay> rays);

/// Traces paths from the camera, and returns the portals of their rays. A pure function of the
/// scene and the shape of the image. std::nullopt if stopped; adds to `traced` the number of rays.
std::optional<Portals> find_portals(const Scene& scene, const GuidingKey& key,
                                    const Preparation& preparation, std::uint64_t& traced);

}  // namespace bandsaw
