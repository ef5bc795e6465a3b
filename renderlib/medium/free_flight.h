#pragma once

// Free-flight sampling in one segment of a homogeneous medium. It decides whether light is
// scattered in the segment, and at which distance. tracking.h does the same in media that vary in
// space.
//
// Light has three channels with three extinction coefficients. A distance is drawn for one channel.
// Its pdf is the mean of the pdfs of all channels, weighted by the probabilities of the channels
// (balance heuristic over wavelengths: Wilkie, Nawaz, Droske, Weidlich and Hanika 2014, "Hero
// Wavelength Spectral Sampling", section 3.1). The probability of a channel is proportional to the
// amount of its light that is scattered in the segment. The probability of scattering, instead of
// passing, is the scattered share of all light. Absorption is contained in the weights and ends no
// path. So the sum of the channels is the same for every outcome and never larger than before, and
// no channel grows by more than a factor of 3.

#include <array>

#include "renderlib/math/rgb.h"
#include "renderlib/medium/medium.h"

namespace bandsaw {

class FreeFlight {
 public:
  /// A segment of the given length (scene units, > 0, may be infinite), which light of weight
  /// `throughput` (>= 0, finite) enters.
  FreeFlight(const Medium& medium, const Rgb& throughput, double length);

  /// Returns the probability of scattering in the segment, in [0, 1]; 0 if nothing is scattered.
  double scatter_probability() const;

  /// Samples the distance at which light is scattered, in [0, length]. `choice` selects the
  /// channel, u the distance; both in [0, 1). scatter_probability() MUST NOT be 0.
  double sample(double choice, double u) const;
  /// Returns the pdf of `sample()` with respect to length. scatter_probability() MUST NOT be 0.
  double pdf(double distance) const;

  /// Returns throughput * scattering * exp(-extinction * distance): the weight scattered per
  /// length.
  Rgb scattered(double distance) const;
  /// Returns the weight after scattering was chosen: scattered() / (scatter_probability() * pdf()).
  Rgb after_scattering(double distance) const;
  /// Returns the weight after passing was chosen: passing() / (1 - scatter_probability()).
  Rgb after_passing() const;
  /// Returns the weight of the light that passes the whole segment: throughput * transmittance.
  Rgb passing() const;
  /// Returns the weight scattered along the whole segment: throughput * scattering * the integral
  /// of exp(-extinction * s) over s in [0, length] (`reach` in attenuation.h).
  Rgb all_scattered() const;

 private:
  using Channels = std::array<double, 3>;
  static Rgb color(const Channels& c, double scale);
  static double sum(const Channels& c) { return c[0] + c[1] + c[2]; }
  Channels scattered_channels(double distance) const;

  double length_;
  Channels extinction_;
  Channels entering_;       ///< throughput times the scattering coefficient
  Channels all_scattered_;  ///< as all_scattered()
  Channels passing_;        ///< as passing()
};

}  // namespace bandsaw
