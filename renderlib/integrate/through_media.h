#pragma once

// What happens to a path between two surfaces, where there are media.
//
// In every stretch of medium a light is asked at one distance, and the path is scattered at another
// one or passes. The distance for the light comes either from the light that is scattered
// (medium/flight.h) or from where a light seems to be (medium/equiangular.h), both by one density
// (asked_distance.h); light that the path then finds by itself is weighed against it by the power
// heuristic over distance and direction together.

#include "renderlib/integrate/path_state.h"

namespace bandsaw {

enum class Passage {
  kThrough,    ///< the path reaches what is at the end, its throughput faded
  kScattered,  ///< it goes on from a point of a medium, by its new ray and departure
  kEnded,      ///< nothing of it is left
};

/// Takes the path along its ray for `length`, scene units, > 0, maybe infinite, as its scattering
/// number `depth` or on the way to it; at the largest depth and with local shading nothing is
/// scattered into another direction. The scene MUST need media.
Passage through_media(const PathContext& context, double length, std::uint32_t depth,
                      PathState& path);

/// The share of light that passes along the ray, between surfaces and through media.
Rgb passing_light(const Scene& scene, const Ray& ray, std::uint64_t& rays);

}  // namespace bandsaw
