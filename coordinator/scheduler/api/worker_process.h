#pragma once

// Ids of worker processes: hashes of the instance name that each process chooses for itself when it
// starts. They are stored on disk and compared after a restart of the coordinator, so their values
// MUST NOT change.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "coordinator/scheduler/api/ids.h"
#include "renderlib/render/hash64.h"

namespace bandsaw::coordinator {

inline std::uint64_t text_hash(const std::string& text) {
  Hash64 hash;
  hash.add(std::as_bytes(std::span(text)));
  return hash.value();
}

/// Returns the id under which bands on disk and journal records name a worker process.
inline WorkerProcessId worker_process_id(const std::string& instance) {
  return text_hash(instance);
}

}  // namespace bandsaw::coordinator
