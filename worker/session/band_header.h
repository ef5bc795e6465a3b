#pragma once

#include <string>

#include "proto/farm.pb.h"
#include "worker/executor/task.h"
#include "worker/session/session.h"

namespace bandsaw::worker {

/// Payload of a finished band: its sums as bytes.
struct BandPayload {
  std::uint64_t size = 0;  ///< bytes
  wire::Digest digest;
};

/// Returns the header under which the pixels of a task are sent. `instance`: of the worker, as in
/// its Hello.
farm::BandHeader band_header(const Task& task, const BandPayload& payload, const Counters& counters,
                             const RenderCost& cost, const std::string& instance,
                             const LeaseName& lease);

}  // namespace bandsaw::worker
