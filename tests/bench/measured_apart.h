#pragma once

// Does work in a child process, so that the measured peak memory does not include other work.
// growth_bench uses it to measure how time and memory grow with a scene.

#include <functional>

namespace bandsaw::bench {

/// The figures of one scene.
struct Figures {
  double build_s = 0;        ///< from description to scene, wall clock, all threads
  double ns_per_sample = 0;  ///< CPU time
  double ns_per_ray = 0;     ///< CPU time, including shading
  double first_rows_s = 0;   ///< from the package on disk to pixels, wall clock; 0 if not measured
  double peak_bytes = 0;     ///< resident memory of the whole process; set by measured_apart
};

/// Runs `work` in a child process, and returns its result with peak_bytes. If the child fails, this
/// program exits with a message.
Figures measured_apart(const std::function<Figures()>& work);

}  // namespace bandsaw::bench
