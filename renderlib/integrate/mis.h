#pragma once

// Multiple importance sampling (Veach 1997, "Robust Monte Carlo Methods for Light Transport
// Simulation", chapter 9): the weights of strategies that can produce the same light.
//
// These strategies are weighed against each other:
//
// - At a surface: light sampling against BSDF sampling, by the power heuristic (path.cpp). For the
//   background, sampling through portals (openings of a room) is weighed against both.
// - In a medium: light sampling at a sampled distance against free-flight sampling and phase
//   function sampling, by the power heuristic over the product of distance pdf and direction pdf
//   (through_media.cpp, through_grid_medium.cpp).
// - Through a lens: light sampling through the point in focus against the camera ray, by the power
//   heuristic (through_lens.cpp).
// - Among the distance strategies of light sampling in a medium: equiangular sampling towards
//   several pivots and free-flight sampling, by the balance heuristic (light_distance_sampler.h).
// - Among the pixels that reuse paths: the pdfs with which each pixel samples a shared vertex, by
//   the balance heuristic (path_reuse.cpp).
//
// The weight is 1 where only one strategy can produce the light:
//
// - Light sampling alone: delta lights.
// - BSDF sampling alone: emission that is hit by camera rays, after specular directions, behind a
//   hidden boundary of nested glass (a boundary inside a glass of higher priority), or beyond a
//   surface that the path passed. The exception to the last case is a surface that samples lights
//   on both of its sides (is_diffuse_behind).

#include <cmath>

#include "renderlib/light/receiver.h"

namespace bandsaw {

/// Returns the MIS weight p^2 / (p^2 + q^2) of a sample with pdf p > 0 that another strategy
/// samples with pdf q; does not overflow. (Power heuristic: Veach 1997, section 9.2.3.)
inline double power_heuristic(double p, double q) {
  const double ratio = q / p;
  return 1 / (1 + ratio * ratio);
}

/// Returns the pdf that stands for two other strategies with the pdfs p and q in power_heuristic(),
/// so that the weight is that of the power heuristic for all three.
inline double combined_pdf(double p, double q) {
  return p > 0 && q > 0 ? std::sqrt(p * p + q * q) : p + q;
}

/// The previous vertex of a path and the pdf with which the path left it: the inputs of the MIS
/// weight of emission at the next hit. For a camera ray whose lens was used for light sampling, the
/// vertex is the point in focus.
struct PreviousVertex {
  Receiver receiver;
  double pdf = 0;
  /// True if light sampling could not have produced the next hit (camera rays, specular
  /// directions). Then the MIS weight of the hit is 1.
  bool delta = true;
  /// At a vertex in a medium: the pdf of its distance in light sampling over that in scattering
  /// (free flight). 1 on surfaces, where both strategies use the same point.
  double distance_pdf_ratio = 1;
  /// True if two conditions hold. The background was also sampled through the portals at this
  /// vertex, for the directions on one side of the surface. The path left the vertex on this side.
  bool portals = false;
};

/// Returns the MIS weight of emission that the path hit from `previous`. `light_pdf`: the pdf with
/// which light sampling samples the same direction. `previous.delta` MUST be false.
inline double bsdf_sampling_weight(const PreviousVertex& previous, double light_pdf) {
  return power_heuristic(previous.pdf, light_pdf * previous.distance_pdf_ratio);
}

}  // namespace bandsaw
