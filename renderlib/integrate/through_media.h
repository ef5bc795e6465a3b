#pragma once

// Transport of a path through the media between two surfaces.
//
// In each segment of a homogeneous medium, light is sampled at one distance, and the path is
// scattered at another distance or passes. LightDistanceSampler samples the distance for light
// sampling from a mixture of free-flight sampling (medium/free_flight.h) and equiangular sampling
// (medium/equiangular.h). Media that vary in space are crossed by delta tracking
// (through_grid_medium.h).
//
// Emission that the scattered path hits is weighted against light sampling by the power heuristic.
// The pdfs in it are products of a distance pdf and a direction pdf.

#include "renderlib/integrate/path_state.h"

namespace bandsaw {

/// Event of a path in the media along its ray.
enum class MediumEvent {
  kPassed,     ///< the path reaches the end of the ray; its throughput is attenuated
  kScattered,  ///< the path continues from a point inside a medium, with a new ray and vertex
  kEnded,      ///< the path ends
};

/// Advances the path along its ray by `length` (scene units, > 0, may be infinite). `depth` is the
/// number of the path's next scattering, which happens here if a medium scatters the path. At the
/// maximum depth, and in local shading (the integrator `direct`), the path is not scattered. The
/// scene MUST have media (`SceneFeatures::media`).
MediumEvent through_media(const PathContext& context, double length, std::uint32_t depth,
                          PathState& path);

}  // namespace bandsaw
