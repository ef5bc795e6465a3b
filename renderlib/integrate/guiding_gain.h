#pragma once

// Estimates what path guiding and photon maps gain in a scene, to decide whether the integrator
// `path` uses them.

#include <optional>

#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/guiding/guiding_field.h"
#include "renderlib/integrate/preparation.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

class CausticMaps;  // renderlib/integrate/caustics.h

/// The variance of one sample of a pixel's luminance, and two parts of it, each divided by the
/// square of the pixel's mean and averaged over pixels. The mean is the measured one, or what the
/// field tells if that is more.
struct GuidingGain {
  /// Measured without guiding. Too low where light is so rare that the few samples miss it.
  double variance = 0;
  /// Expected from the field, so that rare light counts as well. Each may exceed `variance`.
  double by_paths = 0;    ///< part that the cells of paths remove
  double by_photons = 0;  ///< part of the caustics, which photons find

  /// Returns the share of all variance that a part is, in [0, 1].
  double share_of(double part) const;
  /// Returns true if the cells of paths, photon maps, or the cells of photons repay their cost.
  bool paths_pay() const;
  bool maps_pay() const;
  bool photons_pay() const;
};

/// Measures the variance with 8 samples in each of 512 pixels, and estimates the parts from what
/// the cells of `field` tell about the first surface of the same samples that can be guided: the
/// irradiance, and the second moment of a sampled direction's contribution (GuidingCell). The
/// caustics come from `caustics` if it is not null. A pure function of the arguments but the
/// preparation. Returns std::nullopt if it was stopped.
std::optional<GuidingGain> expected_gain(const Scene& scene, const GuidingKey& key,
                                         const GuidingField& field, const CausticMaps* caustics,
                                         const Preparation& preparation);

}  // namespace bandsaw
