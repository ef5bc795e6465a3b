#pragma once

#include <string>

#include "proto/farm.pb.h"
#include "worker/executor/task.h"
#include "worker/session/session.h"

namespace bandsaw::worker {

/// Size and digest of a finished band's pixels: the sums of their samples, as bytes.
struct BandPayload {
  std::uint64_t size = 0;  ///< bytes
  wire::Digest digest;
};

/// Returns the message that precedes a band's pixels when they are sent to the coordinator: by gRPC
/// (FarmCalls) or, from a browser, by HTTP (BrowserSession). `instance`: the id of the worker's
/// process, as in its Hello. `lease`: the band's present lease.
farm::BandHeader band_header(const Task& task, const BandPayload& payload, const Counters& counters,
                             const RenderCost& cost, const std::string& instance,
                             const LeaseName& lease);

}  // namespace bandsaw::worker
