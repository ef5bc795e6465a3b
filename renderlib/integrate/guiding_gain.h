#pragma once

// Estimates what path guiding and photon maps gain in a scene, to decide whether the integrator
// `path` uses them.

#include <optional>

#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/guiding/guiding_field.h"
#include "renderlib/integrate/path.h"
#include "renderlib/integrate/preparation.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// The variance of one sample of a pixel's luminance, and estimates of two parts of it. Each number
/// is divided by the square of the pixel's mean and averaged over pixels. The largest of three
/// numbers serves as the pixel's mean: the measured mean, the mean that the field predicts, and a
/// sixteenth of the image's mean.
///
/// The field consists of cells, which hold the directions from which light arrives at a place
/// (guiding/guiding_cell.h): some are fitted to the light that paths found, others to photons.
struct GuidingGain {
  /// Measured without guiding. It is too low where light is so rare that the few samples miss it.
  double variance = 0;
  double rays = 0;  ///< mean number of rays of a sample
  /// Variance and rays of paths that end after their first scattering, so that they find direct
  /// light only.
  double direct_variance = 0;
  double direct_rays = 0;
  /// The field predicts `by_paths` and `by_photons`, so that light counts that the measured samples
  /// missed. So each of the two may exceed the measured `variance`.
  double by_paths = 0;    ///< part that the cells of paths would remove
  double by_photons = 0;  ///< part of the caustics, which photon maps or cells of photons remove
  /// Light of caustics that the field predicts, relative to the pixel's mean, if the scene has
  /// delta lights; otherwise 0. Path tracing misses the part of this light that comes from delta
  /// lights over mirrors and smooth glass.
  double missing = 0;

  /// Returns the share of `part` in the sum of `part` and the measured variance, in [0, 1]. The sum
  /// is the divisor because the few measured samples may have missed the light of `part`.
  double share_of(double part) const;
  /// Each returns true if its method saves more variance than it costs in time.
  bool paths_pay() const;    ///< guiding by the cells of paths
  bool maps_pay() const;     ///< photon maps
  bool photons_pay() const;  ///< guiding by the cells of photons
  /// Returns true if much light may be missing without photon maps (`missing`).
  bool misses_light() const;
  /// Returns true if photon maps of indirect light are worth a trial. This needs much noise. And
  /// gathering_pays() must be true for maps that would remove all noise and all rays of indirect
  /// light, because real maps remove less.
  bool gathering_may_pay() const;
};

/// Gathering means that indirect light comes from photon maps. Returns true if gathering pays,
/// because it makes the product of variance and rays much smaller. `before` was measured without
/// these maps, and `with` was measured with them.
bool gathering_pays(const GuidingGain& before, const GuidingGain& with);

/// Measures the variances with 8 samples in each of 512 pixels. Follows each sample to its first
/// surface that can be guided, and estimates the parts from the cells of `field` there. A cell
/// holds the irradiance, and the second moment of a sampled direction's contribution (GuidingCell).
/// `options.guiding` MUST be null. The result is a pure function of all arguments except
/// `preparation`. Returns std::nullopt if the preparation was stopped.
std::optional<GuidingGain> expected_gain(const Scene& scene, const GuidingKey& key,
                                         const GuidingField& field, const PathOptions& options,
                                         const Preparation& preparation);

}  // namespace bandsaw
