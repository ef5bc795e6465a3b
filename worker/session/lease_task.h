#pragma once

#include "absl/status/statusor.h"
#include "proto/farm.pb.h"
#include "worker/executor/task.h"

namespace bandsaw::worker {

/// Returns the task of a lease, with id 0. INVALID_ARGUMENT: the digest, the settings, the band or
/// the samples of its half tiles are out of range.
absl::StatusOr<Task> task_of(const farm::Lease& lease);

}  // namespace bandsaw::worker
