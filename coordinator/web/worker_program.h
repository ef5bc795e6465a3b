#pragma once

// The worker's program, as the coordinator hands it out.

#include <string>

#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

/// Held in memory: what is handed out is what its digest was taken of, whatever becomes of the
/// file. It holds no secret.
struct WorkerProgram {
  std::string version;  ///< as it says itself
  std::string bytes;    ///< empty: there is none to hand out
  wire::Digest digest;  ///< of the bytes
};

/// Its file name, and its path at the dashboard.
inline constexpr char kWorkerProgram[] = "bandsaw-worker";

}  // namespace bandsaw::coordinator
