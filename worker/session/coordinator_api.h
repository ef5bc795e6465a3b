#pragma once

#include "absl/status/statusor.h"
#include "proto/farm.pb.h"
#include "worker/executor/load_package.h"
#include "worker/executor/task.h"
#include "worker/session/session.h"

namespace bandsaw::worker {

/// The calls that rendering makes to the coordinator. FarmCalls makes them by gRPC.
class CoordinatorApi {
 public:
  virtual ~CoordinatorApi() = default;
  /// Calls `take` with the bytes of a blob from `offset` to the end. An error of `take` ends the
  /// transfer.
  /// UNAVAILABLE, DEADLINE_EXCEEDED: try again, from the first missing byte. NOT_FOUND: the
  /// coordinator has no such blob. May be called from several threads at the same time.
  virtual absl::Status get_blob(const wire::Digest& digest, std::uint64_t offset,
                                const TakeBytes& take) = 0;
  /// Sends a band's pixels and returns the coordinator's answer. INVALID_ARGUMENT, NOT_FOUND,
  /// FAILED_PRECONDITION: the band will never be accepted. RESOURCE_EXHAUSTED: the coordinator's
  /// disk is full. Other errors: try again. MUST NOT be called by two threads at a time.
  virtual absl::StatusOr<farm::PutBandReply::Outcome> put_band(const FinishedBand& band,
                                                               const LeaseName& lease) = 0;
};

}  // namespace bandsaw::worker
