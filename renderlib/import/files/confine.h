#pragma once

// Confinement of the process that parses files of unknown origin. Before the process parses
// anything, it gives up all rights that it does not need.

#include <cstdint>
#include <string>

#include "absl/status/status.h"

namespace bandsaw {

struct Confinement {
  std::string read_folder;         ///< files are read only below it
  std::string write_folder;        ///< files are written only below it
  std::uint64_t memory_bytes = 0;  ///< address space
  std::uint64_t cpu_seconds = 0;
  std::uint64_t file_bytes = 0;  ///< maximum size of a written file
};

/// Confines this process, which cannot be undone. Sets resource limits and forbids core dumps and
/// new privileges. By a seccomp filter, system calls for network, new programs, new processes,
/// signals to other processes and access to other processes fail with EPERM. If the kernel has
/// Landlock (5.13), only the two folders are accessible. A kernel without Landlock is not an error;
/// then SceneFolder alone restricts which files are opened. If a step fails, returns the system's
/// error.
absl::Status confine_this_process(const Confinement& to);

}  // namespace bandsaw
