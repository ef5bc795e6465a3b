#pragma once

// Fits portals (guiding/portals.h) to rays: the rectangles through which the few rays pass that
// leave the scene.

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

/// There are no portals where more of the rays than this escape: BSDF sampling finds the background
/// often enough.
inline constexpr double kMaxEscaping = 0.25;

/// Returns the part of the rays that escape; 0 without rays.
double escaping_part(absl::Span<const ScatteredRay> rays);

/// Returns the portals through which most of the escaping rays pass and most of the others do not;
/// none if more than kMaxEscaping of the rays escape, or if too few do to know. Depends on the rays
/// and their order only.
Portals portals_of(absl::Span<const ScatteredRay> rays);

}  // namespace bandsaw
