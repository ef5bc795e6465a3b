#pragma once

// How often a worker is lost while it renders a band, through no fault of the band.

#include <cstddef>

namespace bandsaw::coordinator {

class LossRate {
 public:
  void add_band() { add(bands_); }
  void add_loss() { add(losses_); }

  /// How many workers must be lost at one band, each with nothing else in hand, until the chance
  /// that they all were lost for other reasons is at most kMistake; at least `least`, at most
  /// kMaxWitnesses. `own`: losses that were counted of this very band.
  std::size_t witnesses(std::size_t least, std::size_t own) const;

 private:
  static constexpr double kMistake = 1e-6;
  static constexpr std::size_t kMaxWitnesses = 30;
  /// What is assumed of a farm of which nothing is known: one loss beside twenty bands.
  static constexpr double kBandsBefore = 20;
  static constexpr double kLossesBefore = 1;
  /// Both counts are halved above it: what is long past says little.
  static constexpr double kMaxCount = 2'000;

  void add(double& count);

  double bands_ = 0;  ///< stored
  double losses_ = 0;
};

}  // namespace bandsaw::coordinator
