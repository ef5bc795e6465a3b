#pragma once

// Figures of work that is done in a process of its own, so that its memory is its own, too.

#include <functional>

namespace bandsaw::bench {

struct Figures {
  double build_s = 0;        ///< description to scene, wall clock, all threads
  double ns_per_sample = 0;  ///< CPU time
  double ns_per_ray = 0;     ///< CPU time, shading and all
  double first_rows_s = 0;   ///< of its package, from the disk to pixels, wall clock; 0: not asked
  double peak_bytes = 0;     ///< resident, of the whole process; filled in by measured_apart
};

/// What `work` gives. Exits with a message when it fails: this is a bench.
Figures measured_apart(const std::function<Figures()>& work);

}  // namespace bandsaw::bench
