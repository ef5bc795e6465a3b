#pragma once

// Measures work in a separate process, so that its memory is measured separately.

#include <functional>

namespace bandsaw::bench {

struct Figures {
  double build_s = 0;        ///< from description to scene, wall clock, all threads
  double ns_per_sample = 0;  ///< CPU time
  double ns_per_ray = 0;     ///< CPU time, including shading
  double first_rows_s = 0;   ///< from the package on disk to pixels, wall clock; 0 if not measured
  double peak_bytes = 0;     ///< resident memory of the whole process; set by measured_apart
};

/// Returns the result of `work`. Exits with a message if it fails, because this is a benchmark.
Figures measured_apart(const std::function<Figures()>& work);

}  // namespace bandsaw::bench
