#pragma once

// How far light goes through a stretch of a medium before it is scattered, or that it passes.
//
// Light carries three channels with three extinctions. A distance is drawn for one of them and
// weighed by the mean of all densities (the balance heuristic over wavelengths: Wilkie, Nawaz,
// Droske, Weidlich and Hanika 2014, "Hero Wavelength Spectral Sampling", section 3.1). Each channel
// is chosen by how much of its light is scattered on the stretch, and scattering rather than
// passing by how much of all light is: absorption is in the weights and ends nothing. So the sum of
// the channels after the choice is the same whatever was chosen, and never larger than before: no
// channel grows by more than a factor of 3.

#include <array>

#include "renderlib/math/rgb.h"
#include "renderlib/medium/medium.h"

namespace bandsaw {

class Flight {
 public:
  /// Light of weight `throughput` (>= 0, finite) that enters a stretch of this length, scene units
  /// > 0, maybe infinite.
  Flight(const Medium& medium, const Rgb& throughput, double length);

  /// The probability with which light should be scattered here, in [0, 1]; 0 where nothing is.
  double chance() const;

  /// Where it is scattered, in [0, length]; choice, u in [0, 1). chance() MUST NOT be 0.
  double sample(double choice, double u) const;
  /// The density of sample() there, by length. chance() MUST NOT be 0.
  double pdf(double distance) const;

  /// throughput scattering exp(-extinction distance): what is scattered there, over the length.
  Rgb scattered(double distance) const;
  /// The weight after scattering there by choice: scattered() / (chance() pdf()).
  Rgb after_scattering(double distance) const;
  /// The weight after passing by choice: what passes over 1 - chance().
  Rgb after_passing() const;
  /// The weight of what passes.
  Rgb passing() const;
  /// throughput scattering reach: what is scattered along all of the stretch.
  Rgb all_scattered() const;

 private:
  using Channels = std::array<double, 3>;
  static Rgb color(const Channels& c, double scale);
  static double sum(const Channels& c) { return c[0] + c[1] + c[2]; }
  Channels scattered_channels(double distance) const;

  double length_;
  Channels extinction_;
  Channels entering_;  ///< throughput times scattering
  Channels all_scattered_;
  Channels passing_;
};

}  // namespace bandsaw
