#pragma once

// Lamps out of focus. A small lamp far behind the plane of focus becomes a disk: of the rays of one
// pixel few meet it, and these decide the pixel. So a light is asked through the lens, too: seen
// from the point in focus, lamps beyond it are where asking finds them from any point (light/
// lights.h), and the ray that goes on there begins on the lens or the pixel does not see it. What
// is asked and what the camera's ray meets by itself is weighed by the power heuristic.

#include "renderlib/camera/lens_view.h"
#include "renderlib/integrate/path_state.h"

namespace bandsaw {

/// Adds the light of one lamp beyond the focus, and has the path, whose ray MUST be one of the
/// lens' through it, weigh what it meets there; does nothing where only one technique is wanted.
/// `lens` MUST outlive the path's first step.
void ask_through_lens(const PathContext& context, const LensView& lens, PathState& path);

}  // namespace bandsaw
