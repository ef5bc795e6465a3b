#pragma once

// Measures the scheduler's efficiency on a farm that is simulated in virtual time, without
// failures. A band is a range of rows and samples that one worker renders. The time that a band
// takes follows from a given cost of each row. A job's last phase, its tail, is the time in which
// some workers have nothing left to do.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coordinator/scheduler/scheduler.h"

namespace bandsaw::coordinator::sim {

/// The farm, and the one job that it renders.
struct BenchFarm {
  std::vector<double> speeds;                    ///< of each worker, pixel samples per second, > 0
  std::function<double(std::uint32_t)> cost_of;  ///< relative work of a sample, by row; mean 1
  std::uint32_t width = 1920;
  std::uint32_t height = 1080;
  std::uint64_t samples = 64;
  std::uint32_t threads = 8;  ///< of each worker
  double noise = 0;           ///< maximum relative deviation of a band's time
  double trip_s = 0.002;      ///< seconds that a message takes, in either direction
  double upload_s = 0.02;     ///< seconds from the end of a band until it is on disk
  std::uint64_t seed = 1;     ///< of the noise and of the times at which workers join
  double audit_share = 0;     ///< share of the bands that are rendered twice
  /// From this time on, in seconds, the first worker is a hundred times slower; negative: never.
  double stalls_at = -1;
};

struct BenchResult {
  double seconds = 0;  ///< first lease to last result
  /// Work of the job, divided by the work that the workers could do in `seconds`.
  double efficiency = 0;
  double tail = 0;  ///< last phase: share of `seconds` in which some worker was idle
  std::uint64_t bands = 0;
  std::uint64_t wasted = 0;  ///< bands that were rendered, in whole or in part, for nothing
  /// After a quarter of `seconds`: the predicted remaining time, divided by the true one.
  double predicted_left = 0;
  /// Says which invariant was broken, or that the job did not end; empty: neither.
  std::string broken;
};

/// Renders the job on the farm in virtual time.
BenchResult run_bench(const BenchFarm& farm);

}  // namespace bandsaw::coordinator::sim
