#pragma once

// Transport through media that vary in space, without bias (delta tracking: Woodcock et al. 1965).
// Tentative collisions are sampled at the rate of a majorant of the extinction in each region of
// the medium (grid_medium.h), and a random part of them are real ones.
//
// - A flight carries a weight for each of the three channels. Let s be the light that a tentative
//   collision would scatter, and p the light that would pass, each summed over the channels. The
//   probability of scattering is s / (s + p), as in free_flight.h (Kutz, Habel, Li and Novak 2017,
//   "Spectral and Decomposition Tracking for Rendering Heterogeneous Volumes", section 4.1,
//   history-aware). Absorption only lowers the weights. So the sum of the three weights after the
//   collision is the same whether the light is scattered or passes. This sum is never larger than
//   the sum before the collision.
// - Transmittance is estimated by residual ratio tracking (Novak, Selle and Jarosz 2014, "Residual
//   Ratio Tracking for Estimating Attenuation in Participating Media", section 4.2). The control
//   variate is the least density of each region. So in regions of constant density the estimate is
//   exact.
// - Emission is collected at tentative collisions. The regions are equal cubes, and the space
//   around all cubes. In a region where the medium emits, a part of the ray as long as the side of
//   a cube has on average at least two tentative collisions.
//
// Flights whose weight is low end by Russian roulette, and so do flights of very many collisions.

#include "renderlib/math/rgb.h"
#include "renderlib/medium/grid_medium.h"
#include "renderlib/medium/region_walk.h"
#include "renderlib/sampling/sampler.h"

namespace bandsaw {

/// Outcome of a flight through a segment.
struct Flight {
  bool scattered = false;
  double distance = 0;  ///< where the light was scattered, if it was
  Rgb throughput;       ///< weight of the light that is scattered there, or that passes the segment
  /// Emission towards the start of the segment. At each tentative collision, the emission is
  /// multiplied by the weight before the collision.
  Rgb emitted;
};

/// The first two random numbers of a flight, each in [0, 1). The caller passes them, so that the
/// flights of one pixel can be stratified. Further random numbers come from the NumberStream.
struct FirstCollision {
  double choice = 0;
  double distance = 0;
};

/// Sends light of weight `throughput` (>= 0, finite) through the first `length` (> 0, may be
/// infinite) of the ray. The light is scattered in this segment or passes it.
Flight fly(const GridMedium& medium, const GridRay& ray, double length, const Rgb& throughput,
           const FirstCollision& first, NumberStream& numbers);

/// A point at which the medium scatters light.
struct ScatteringPoint {
  double distance = 0;
  Rgb weight;  ///< black: there is none
};

/// Light that passes a segment in which the path itself is not scattered.
struct Passage {
  Rgb throughput;  ///< estimate of the weight that passes
  Rgb emitted;     ///< as Flight::emitted
  /// A random point with a pdf proportional to the light that is scattered there. Its weight is an
  /// estimate of all light that is scattered in the segment.
  ScatteringPoint scattered;
};

/// Sends light of weight `throughput` (>= 0, finite) through the first `length` (> 0, may be
/// infinite) of the ray. The path always passes this segment, and is attenuated in it.
/// Passage::scattered stands for the light that is scattered.
Passage pass(const GridMedium& medium, const GridRay& ray, double length, const Rgb& throughput,
             NumberStream& numbers);

/// Returns an estimate of the transmittance of the first `length` of the ray, by channel.
Rgb estimate_transmittance(const GridMedium& medium, const GridRay& ray, double length,
                           NumberStream& numbers);

}  // namespace bandsaw
