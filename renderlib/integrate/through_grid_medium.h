#pragma once

// Transport of a path through one segment of a medium that varies in space (medium/tracking.h).
//
// The path passes the segment, or it is scattered at a collision that delta tracking finds. Light
// is sampled at that collision. Emission is collected at tentative collisions.

#include <cstdint>

#include "renderlib/integrate/medium_traversal.h"
#include "renderlib/integrate/path_state.h"
#include "renderlib/integrate/through_media.h"

namespace bandsaw {

/// Advances the path, whose ray is `ray`, through segment number `number` of that ray. `depth` is
/// the number of the path's next scattering, which happens here if the medium scatters the path.
/// The segment's medium MUST vary in space.
MediumEvent through_grid_medium(const PathContext& context, const Ray& ray,
                                const MediumSegment& segment, std::uint32_t number,
                                std::uint32_t depth, PathState& path);

}  // namespace bandsaw
