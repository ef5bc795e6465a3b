#pragma once

// What must hold of a job before the core hears of it.

#include "absl/status/status.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "coordinator/store/blob_store.h"
#include "renderlib/image/display.h"

namespace bandsaw::coordinator {

/// INVALID_ARGUMENT: a field out of range, or a package that is none. FAILED_PRECONDITION: a blob
/// of the package is missing; the first is named. DATA_LOSS: the manifest's file is damaged. Reads
/// the disk.
absl::Status check_submit(const JobSpec& spec, BlobStore& blobs);

/// How the package wants its image shown; the default where its manifest cannot be read any more.
Display display_of(const DigestHex& manifest, BlobSource& blobs);

}  // namespace bandsaw::coordinator
