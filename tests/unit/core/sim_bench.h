#pragma once

// A calm farm in virtual time whose workers sleep by a cost map: how much of their time is used,
// and how long the end drags on.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coordinator/core/core.h"

namespace bandsaw::coordinator::sim {

struct BenchFarm {
  std::vector<double> speeds;                    ///< of each worker, pixel samples a second, > 0
  std::function<double(std::uint32_t)> cost_of;  ///< of a row's sample, 1: one sample's work
  std::uint32_t width = 1920;
  std::uint32_t height = 1080;
  std::uint64_t samples = 64;
  std::uint32_t threads = 8;  ///< said of each worker
  double noise = 0;           ///< a band takes up to this part longer or shorter than its work
  double trip_s = 0.002;      ///< of a message, either way
  double upload_s = 0.02;     ///< of a band, until it is on disk
  std::uint64_t seed = 1;
  double audit_share = 0;  ///< of all bands: rendered twice
  /// A worker that slows down to a hundredth at this time; none: no worker.
  double stalls_at = -1;
};

struct BenchResult {
  double seconds = 0;     ///< first lease to last result
  double efficiency = 0;  ///< work done once, of what the workers could do in that time
  double tail = 0;        ///< last result after the first worker idles for good, of the whole
  std::uint64_t bands = 0;
  std::uint64_t wasted = 0;  ///< bands or parts rendered for nothing
  double told_left = 0;      ///< time left as told after a quarter of the time, over what was left
  std::string broken;        ///< an invariant, or a job that did not end
};

BenchResult run_bench(const BenchFarm& farm);

}  // namespace bandsaw::coordinator::sim
