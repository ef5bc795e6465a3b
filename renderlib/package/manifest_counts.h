#pragma once

// The counts of a manifest, by the sizes of its blobs.

#include "absl/status/status.h"
#include "proto/package.pb.h"

namespace bandsaw {

/// INVALID_ARGUMENT: a mesh, a group or the loose shapes are more than a tree holds
/// (scene/check_counts.h). No blob is read, so nothing is taken for what cannot be rendered.
absl::Status check_counts(const package::Manifest& manifest);

}  // namespace bandsaw
