#pragma once

// What keeps a parser of foreign files from doing harm: the process gives up what it does not need
// before it reads anything.

#include <cstdint>
#include <string>

#include "absl/status/status.h"

namespace bandsaw {

struct Confinement {
  std::string read_folder;         ///< files are read only below it
  std::string write_folder;        ///< files are written only below it
  std::uint64_t memory_bytes = 0;  ///< address space
  std::uint64_t cpu_seconds = 0;
  std::uint64_t file_bytes = 0;  ///< largest file that is written
};

/// Resource limits; no core dump; no new privileges; no network, no new program, no new process, no
/// signal to or look into another process (seccomp, answered with EPERM); and, where the kernel has
/// Landlock (5.13), the two folders and nothing else of the disk. A kernel without Landlock is not
/// an error: then SceneFolder alone decides what is opened. Cannot be undone. The error is the
/// system's.
absl::Status confine_this_process(const Confinement& to);

}  // namespace bandsaw
