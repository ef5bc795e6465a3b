#pragma once

// Checks of a job before the scheduler receives it.

#include <cstdint>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "coordinator/scheduler/api/sequence_spec.h"
#include "coordinator/store/blob_store.h"
#include "renderlib/image/display.h"

namespace bandsaw::coordinator {

/// Sets spec.package_bytes. INVALID_ARGUMENT: a field is out of range, or the manifest is not a
/// package. FAILED_PRECONDITION: a blob of the package is missing; names the first. DATA_LOSS: the
/// manifest's file is damaged. Reads the disk, and marks the package's blobs as used.
absl::Status check_submit(JobSpec& spec, BlobStore& blobs);

/// INVALID_ARGUMENT: a field is out of range.
absl::Status check_sequence(const SequenceSpec& spec);

/// Checks a package, as check_submit. Returns its bytes, the manifest included.
absl::StatusOr<std::uint64_t> check_package(const DigestHex& manifest, BlobStore& blobs);

/// Returns how the package wants its image displayed; the default if its manifest cannot be read.
Display display_of(const DigestHex& manifest, BlobSource& blobs);

}  // namespace bandsaw::coordinator
