#pragma once

// Measures the CPU time of this process, for `bandsaw render` and `bandsaw study`.

#include <ctime>

namespace bandsaw::coordinator {

/// Returns the CPU time of all threads of this process, in seconds.
inline double process_cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

}  // namespace bandsaw::coordinator
