// Measures how well the scheduler uses its workers' time. The workers are simulated in virtual
// time, and a band (the rows and samples that one lease gives to a worker) takes the time that a
// cost map gives it. So only the last column of the table, the CPU time of a band, depends on this
// machine.
//
// The time of a job goes from the first lease to the last result. Efficiency: the work of the job,
// divided by the work that the workers could do in the time of the job. Tail: the last part of the
// time, in which some worker was idle, as a share of the whole time. Audit: the share of bands that
// a second worker renders too, to compare the pixels.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "tests/unit/scheduler/sim_bench.h"

namespace {

using bandsaw::coordinator::sim::BenchFarm;
using bandsaw::coordinator::sim::BenchResult;

constexpr std::uint32_t kWidth = 1920;
constexpr std::uint32_t kHeight = 1080;
constexpr std::uint64_t kSamples = 64;

/// Cost of a row, relative to the mean of all rows. Here every row costs the same.
double even(std::uint32_t) { return 1; }
/// Rows of the upper half cost 20 times as much as those of the lower half; the mean is 1.
double uneven(std::uint32_t row) { return row < kHeight / 2 ? 40.0 / 21 : 2.0 / 21; }

/// Returns the speeds, in samples of pixels per second, of `count` workers that together need
/// `seconds` for the image. Unless `equal`, every second one is four times as fast as the others.
std::vector<double> speeds(std::size_t count, double seconds, bool equal) {
  const double mean = double{kWidth} * kHeight * kSamples / seconds / static_cast<double>(count);
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(mean * (equal ? 1 : i % 2 == 0 ? 0.4 : 1.6));
  }
  return out;
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Least and largest of the values that were added.
struct Spread {
  double least = 1e300;
  double most = -1e300;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

/// Prints one row of the table, over ten seeds. Returns false if a job broke an invariant or did
/// not end.
bool measure(const char* name, BenchFarm farm) {
  Spread efficiency;
  Spread tail;
  std::uint64_t bands = 0;
  std::uint64_t wasted = 0;
  const double began = cpu_seconds();
  for (farm.seed = 1; farm.seed <= 10; ++farm.seed) {
    const BenchResult one = bandsaw::coordinator::sim::run_bench(farm);
    if (!one.broken.empty()) {
      std::fprintf(stderr, "farm_bench: %s: %s\n", name, one.broken.c_str());
      return false;
    }
    efficiency.add(100 * one.efficiency);
    tail.add(100 * one.tail);
    bands += one.bands;
    wasted += one.wasted;
  }
  std::printf("| %s | %.2f–%.2f %% | %.2f–%.2f %% | %.2f %% | %.0f µs |\n", name, efficiency.least,
              efficiency.most, tail.least, tail.most,
              100.0 * static_cast<double>(wasted) / static_cast<double>(bands),
              1e6 * (cpu_seconds() - began) / static_cast<double>(bands));
  return true;
}

}  // namespace

int main() {
  std::printf(
      "| 1920x1080, 64 samples, 60 s of work for all workers together; 10 runs | efficiency | "
      "tail | bands rendered in vain or for audits | "
      "CPU time a band, coordinator and simulation together |\n"
      "| --- | --- | --- | --- | --- |\n");
  bool ok = true;
  for (const double audit : {0.0, 0.01}) {
    const char* const with = audit > 0 ? ", audit 1 %" : "";
    const auto row = [&](const char* what, BenchFarm farm) {
      farm.audit_share = audit;
      ok = measure((std::string(what) + with).c_str(), farm) && ok;
    };
    row("16 equal workers, even", {.speeds = speeds(16, 60, /*equal=*/true), .cost_of = even});
    row("16 equal workers, uneven 20:1",
        {.speeds = speeds(16, 60, /*equal=*/true), .cost_of = uneven});
    row("16 workers of speeds 1:4, even",
        {.speeds = speeds(16, 60, /*equal=*/false), .cost_of = even});
    row("16 workers of speeds 1:4, uneven 20:1, times ± 30 %",
        {.speeds = speeds(16, 60, /*equal=*/false), .cost_of = uneven, .noise = 0.3});
  }
  return ok ? 0 : 1;
}
