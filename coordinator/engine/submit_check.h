#pragma once

// Checks of a job or a sequence before the scheduler receives it.

#include <cstdint>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "coordinator/scheduler/api/sequence_spec.h"
#include "coordinator/store/blob_store.h"
#include "renderlib/image/display.h"

namespace bandsaw::coordinator {

/// Checks the fields of a job and its scene package, and sets spec.package_bytes. INVALID_ARGUMENT:
/// a field is out of range, the name is not clean text (renderlib/base/clean_text.h), or the
/// manifest of the package is invalid. FAILED_PRECONDITION: a blob of the package is missing; the
/// message names the first one. DATA_LOSS: the manifest's file is damaged. Reads the disk, and
/// marks the package's blobs as used.
absl::Status check_submit(JobSpec& spec, BlobStore& blobs);

/// Checks the fields of a sequence. INVALID_ARGUMENT: a field is out of range, or the name is not
/// clean text.
absl::Status check_sequence(const SequenceSpec& spec);

/// Checks a scene package as check_submit does. Returns the size of its manifest and all of its
/// blobs, in bytes.
absl::StatusOr<std::uint64_t> check_package(const DigestHex& manifest, BlobStore& blobs);

/// Returns the exposure and tone that the scene sets for the display of its image. Returns the
/// default if the manifest cannot be read.
Display display_of(const DigestHex& manifest, BlobSource& blobs);

}  // namespace bandsaw::coordinator
