#pragma once

// What a farm of real processes is measured by, one row of a table each.

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace bandsaw::bench {

struct Figure {
  std::string name;
  std::string aim;
  std::string unit;
  std::vector<double> measured;
  std::string remark;  ///< why it is empty, or what was seen beside it
};

/// From the moment that a worker is killed, frozen (SIGSTOP) or cut off to the coordinator's word
/// that it is gone.
std::vector<Figure> loss_figures();

/// From the start of `bandsaw submit` to the first finished rows that it tells of.
std::vector<Figure> first_pixel_figures();

/// Bands that were finished and rendered again after the coordinator's kill -9.
Figure rendered_again_figure();

/// The error of the time left that is told once a quarter of a job's time has passed, over what was
/// left in truth.
Figure time_left_figure();

using Clock = std::chrono::steady_clock;
inline double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace bandsaw::bench
