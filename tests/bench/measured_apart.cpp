// Makes each measurement in a child process of its own, so that the peak memory of one measurement
// does not include the memory of earlier ones. The child returns its figures through a pipe.

#include "tests/bench/measured_apart.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

namespace bandsaw::bench {

Figures measured_apart(const std::function<Figures()>& work) {
  std::fflush(stdout);
  int ends[2] = {};
  if (pipe(ends) != 0) {
    std::perror("pipe");
    std::exit(1);
  }
  const pid_t child = fork();
  if (child == 0) {
    const Figures figures = work();
    _exit(write(ends[1], &figures, sizeof figures) == sizeof figures ? 0 : 1);
  }
  close(ends[1]);  // otherwise read() would wait forever if the child dies
  Figures figures;
  int status = 0;
  rusage used{};
  const bool received = child > 0 && read(ends[0], &figures, sizeof figures) == sizeof figures;
  close(ends[0]);
  if (!received || wait4(child, &status, 0, &used) != child || status != 0) {
    std::fprintf(stderr, "a measurement failed; maybe there was too little memory\n");
    std::exit(1);
  }
  figures.peak_bytes = 1024.0 * static_cast<double>(used.ru_maxrss);
  return figures;
}

}  // namespace bandsaw::bench
