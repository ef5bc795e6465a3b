#pragma once

// The measurements of the program farm_figures. Each measurement starts farms of real processes and
// returns one or more rows of the table that the program prints.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace bandsaw::bench {

/// A row of the table.
struct Figure {
  std::string name;
  std::string aim;               ///< the value that is wanted, as text: "≤ 5 s"
  std::string unit;              ///< printed directly after each value: " s"
  std::vector<double> measured;  ///< one value for each run
  std::string remark;            ///< reason for an empty result, or another observation
};

/// Time until the coordinator reports the loss of a worker. The time begins when the worker is
/// killed, frozen (SIGSTOP) or disconnected.
std::vector<Figure> loss_figures();

/// Time from the start of `bandsaw submit` to the command's first report of finished samples.
std::vector<Figure> first_pixel_figures();

/// Number of finished bands (parts of the image) that were rendered again after the coordinator was
/// killed by SIGKILL.
Figure rendered_again_figure();

/// Error, in percent, of the remaining time that is reported after a quarter of a job's time.
Figure time_left_figure();

using Clock = std::chrono::steady_clock;
inline double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace bandsaw::bench
