#pragma once

// A farm without failures in virtual time, whose bands take the time that a cost map says: measures
// the efficiency and the length of a job's last phase.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coordinator/scheduler/scheduler.h"

namespace bandsaw::coordinator::sim {

struct BenchFarm {
  std::vector<double> speeds;                    ///< of each worker, pixel samples per second, > 0
  std::function<double(std::uint32_t)> cost_of;  ///< work of a sample of a row; 1: mean
  std::uint32_t width = 1920;
  std::uint32_t height = 1080;
  std::uint64_t samples = 64;
  std::uint32_t threads = 8;  ///< of each worker
  double noise = 0;           ///< relative deviation of a band's time, at most
  double trip_s = 0.002;      ///< of a message, either way
  double upload_s = 0.02;     ///< of a band, until it is on disk
  std::uint64_t seed = 1;
  double audit_share = 0;  ///< of all bands: rendered twice
  /// A worker that slows down to a hundredth at this time; none: no worker.
  double stalls_at = -1;
};

struct BenchResult {
  double seconds = 0;     ///< first lease to last result
  double efficiency = 0;  ///< work of the job over the work that the workers could do in that time
  double tail = 0;        ///< time from the first idle worker to the last result, over all
  std::uint64_t bands = 0;
  std::uint64_t wasted = 0;   ///< bands or parts of bands rendered for nothing
  double predicted_left = 0;  ///< remaining time predicted after a quarter, over the true one
  std::string broken;         ///< a broken invariant, or a job that did not end
};

BenchResult run_bench(const BenchFarm& farm);

}  // namespace bandsaw::coordinator::sim
