#pragma once

// Fits portals (guiding/portals.h) to rays. A portal is a rectangular opening of a scene that only
// few rays leave. Most of these rays pass through a portal.

#include "absl/types/span.h"
#include "renderlib/guiding/portals.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// A ray that a surface scattered.
struct ScatteredRay {
  Vec3 origin;
  Vec3 normal;           ///< of the surface, unit, on the side of the ray
  Vec3 direction;        ///< unit
  bool escapes = false;  ///< leaves the scene, to where the background is not black
};

/// If more than this part of the rays escape, the scene gets no portals, because BSDF sampling
/// finds the background often enough.
inline constexpr double kMaxEscaping = 0.25;

/// Returns the part of the rays that escape; 0 without rays.
double escaping_part(absl::Span<const ScatteredRay> rays);

/// Returns the portals through which most of the escaping rays pass and most other rays do not.
/// Returns no portals if more than the part kMaxEscaping of the rays escape, or if too few rays
/// escape to tell where an opening is. The result depends only on the rays and their order.
Portals portals_of(absl::Span<const ScatteredRay> rays);

}  // namespace bandsaw
