#pragma once

// Photons of indirect light, for final gathering (Jensen 1996, "Global Illumination Using Photon
// Maps", section 4). A receiver is a surface that scatters light over wide angles (caustics.h). Let
// a path from the camera meet three receivers A, B and C, in this order. At B, photons give an
// estimate of the light that arrives at B from other receivers. Beyond B, the path collects only
// light that arrives at B without meeting another receiver. So the path ends at C.
//
// All light that a receiver scatters is thus divided into two parts. The first part arrives from
// lamps without meeting another receiver, directly or over mirrors, glass and other surfaces. It is
// found by paths, but the caustics in it come from a photon map of caustics. The second part
// arrives from other receivers. It is estimated from the photons.
//
// A photon starts at a random point of a receiver, in a random direction. The power of the photon
// is computed from the radiance that the point scatters in the direction of the photon. Only the
// first part of the light at the point is counted in this radiance. A path measures the radiance as
// if the camera were in the direction of the photon. So lamps, environments, portals and caustics
// light the starting points exactly as they light the paths of the image. After its start the
// photon is scattered as paths are, and it is stored at every receiver that it meets.

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/integrate/caustics.h"
#include "renderlib/integrate/photon_sources.h"
#include "renderlib/integrate/trace_photons.h"

namespace bandsaw {

/// A point and a direction in which photons start.
struct PhotonOrigin {
  std::uint64_t number = 0;  ///< determines the point and the direction
  Rgb power;                 ///< flux (StoredPhoton::power) of all photons that start here
  /// True if the point scatters the same radiance in all directions, so that each photon that
  /// starts there can have a direction of its own.
  bool diffuse = false;
};

/// The origins of a chunk that have power, in order.
struct PhotonOrigins {
  std::vector<PhotonOrigin> items;
  std::uint64_t rays = 0;  ///< rays that were traced
};

/// Finds origins of photons. In this function `chunk.photons` is the number of points that are
/// tried, and [first, last) are numbers of points. Each origin is a pure function of the scene, the
/// sources, the seed, the number of the map and the number of the point. `sources.surfaces` MUST be
/// set and not empty. `maps` has the photon map of caustics that is used for all samples.
PhotonOrigins find_origins(const Scene& scene, const PhotonSources& sources, const PhotonMaps& maps,
                           const PhotonChunk& chunk);

/// Traces photons from the origins. The origin of each photon is chosen by systematic sampling, in
/// proportion to the luminance of the power, so that all photons of a map start with the same
/// luminance. `luminance_up_to`: for each origin, the sum of the luminances up to and including its
/// own; not empty. Sets only `photons` and `rays` of the result.
TracedPhotons trace_indirect_photons(const Scene& scene, const PhotonSources& sources,
                                     absl::Span<const PhotonOrigin> origins,
                                     absl::Span<const double> luminance_up_to,
                                     const PhotonChunk& chunk);

}  // namespace bandsaw
