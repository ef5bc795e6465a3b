#pragma once

// The manifest's own form: what can be checked without its blobs.

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/package/package.h"

namespace bandsaw {

/// INVALID_ARGUMENT: too large, not a manifest, another format, or its name, size, depth or
/// warnings are out of range.
absl::StatusOr<package::Manifest> parse_manifest(const std::string& bytes);

/// "scene package: <field>: <what is wrong>"
absl::Status manifest_error(const std::string& field, const std::string& what);

/// INVALID_ARGUMENT naming `field`: the digest's length or the size is out of range.
absl::StatusOr<BlobRef> blob_ref(const package::Blob& blob, const std::string& field);

}  // namespace bandsaw
