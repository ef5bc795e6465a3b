#pragma once

// The worker's program, which machines download from the coordinator: one file per architecture.

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

/// Returns the name that `uname -m` prints on Linux: "x86_64", "aarch64".
constexpr absl::string_view machine_name(Machine machine) {
  return machine == Machine::kX86_64 ? "x86_64" : "aarch64";
}

/// Returns the name that Debian and other systems use: "amd64", "arm64".
constexpr absl::string_view other_machine_name(Machine machine) {
  return machine == Machine::kX86_64 ? "amd64" : "arm64";
}

/// Returns the architecture that has this name in either spelling; std::nullopt: none has it.
constexpr std::optional<Machine> machine_named(absl::string_view name) {
  for (const Machine machine : kMachines) {
    if (name == machine_name(machine) || name == other_machine_name(machine)) {
      return machine;
    }
  }
  return std::nullopt;
}

/// The program of one architecture, read from its file. It is held in memory, so that `digest`
/// remains the digest of the bytes that are handed out even if the file changes. The program
/// contains no secret.
struct WorkerProgram {
  Machine machine = kThisMachine;
  std::string version;  ///< as the program's bytes state it (proto/wire/worker_mark.h)
  std::string bytes;
  wire::Digest digest;  ///< digest of `bytes`
};

/// Programs to hand out, at most one per architecture.
using WorkerPrograms = std::vector<WorkerProgram>;

/// File name of the program, and its path at the dashboard.
inline constexpr char kWorkerProgram[] = "bandsaw-worker";

}  // namespace bandsaw::coordinator
