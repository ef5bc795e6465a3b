#pragma once

// Light sampling through a lens, for lights that are out of focus. A small light far behind the
// plane of focus becomes a disk in the image: few rays of a pixel hit it, but they dominate the
// pixel's variance. So a light is also sampled from the point in focus, the point of the plane of
// focus through which the camera ray passes. The line from the light sample through the point in
// focus must cross the lens; otherwise the pixel does not see the sample. The estimate and the
// emission hit by the camera ray itself are weighted by the power heuristic.

#include "renderlib/camera/lens_view.h"
#include "renderlib/integrate/path_state.h"

namespace bandsaw {

/// Adds a light-sampling estimate for one light beyond the plane of focus, and sets the path's
/// previous vertex so that the next hit gets the matching MIS weight. The path's ray MUST pass
/// through the point in focus of `lens`. Does nothing if no light can be in the cone beyond the
/// point in focus. Does nothing either if the render uses only light sampling or only scattering,
/// that is, if PathOptions::technique is not `kBoth`. `lens` MUST outlive the path's first step.
void sample_light_through_lens(const PathContext& context, const LensView& lens, PathState& path);

}  // namespace bandsaw
