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
  /// As TransferBlob. May be called from several threads at the same time.
  virtual absl::Status get_blob(const wire::Digest& digest, std::uint64_t offset,
                                const TakeBytes& take) = 0;
  /// Sends a band and returns the coordinator's answer; errors as SendBand. One call at a time.
  virtual absl::StatusOr<farm::PutBandReply::Outcome> put_band(const FinishedBand& band,
                                                               const LeaseName& lease) = 0;
};

}  // namespace bandsaw::worker
