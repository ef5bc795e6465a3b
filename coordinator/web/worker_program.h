#pragma once

// The worker's program as the coordinator hands it out: one file for each architecture of machines.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

/// The architectures that workers are built for. All are little-endian.
enum class Machine { kX86_64, kAarch64 };
inline constexpr std::array kMachines = {Machine::kX86_64, Machine::kAarch64};

/// The architecture that this program was compiled for.
#if defined(__x86_64__)
inline constexpr Machine kThisMachine = Machine::kX86_64;
#elif defined(__aarch64__)
inline constexpr Machine kThisMachine = Machine::kAarch64;
#else
#error "Machine (coordinator/web/worker_program.h) has no name for this architecture yet"
#endif

/// As `uname -m` says it on Linux: "x86_64", "aarch64".
constexpr absl::string_view machine_name(Machine machine) {
  return machine == Machine::kX86_64 ? "x86_64" : "aarch64";
}

/// As Debian and other systems say it: "amd64", "arm64".
constexpr absl::string_view other_machine_name(Machine machine) {
  return machine == Machine::kX86_64 ? "amd64" : "arm64";
}

/// The architecture of either name. nullopt: there is none of that name.
constexpr std::optional<Machine> machine_named(absl::string_view name) {
  for (const Machine machine : kMachines) {
    if (name == machine_name(machine) || name == other_machine_name(machine)) {
      return machine;
    }
  }
  return std::nullopt;
}

/// Held in memory: what is handed out is what its digest was taken of, whatever becomes of the
/// file. It holds no secret.
struct WorkerProgram {
  Machine machine = kThisMachine;
  std::string version;  ///< as its file says
  std::string bytes;
  wire::Digest digest;  ///< of the bytes
};

/// At most one for each architecture.
using WorkerPrograms = std::vector<WorkerProgram>;

/// Its file name, and its path at the dashboard.
inline constexpr char kWorkerProgram[] = "bandsaw-worker";

}  // namespace bandsaw::coordinator
