#pragma once

#include "absl/status/statusor.h"
#include "proto/farm.pb.h"
#include "worker/executor/task.h"

namespace bandsaw::worker {

/// Converts the coordinator's message of a lease to the task that the worker renders: a band of a
/// scene, with settings. The task's id is 0; the caller sets the id. INVALID_ARGUMENT: the digest,
/// the settings, the band, or the samples of its half tiles (halves of the pixels of a tile, in an
/// adaptive job) are out of range.
absl::StatusOr<Task> task_of(const farm::Lease& lease);

}  // namespace bandsaw::worker
