#pragma once

// Parsing of manifests, with all checks that need no blobs.

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/package/package.h"

namespace bandsaw {

/// Returns INVALID_ARGUMENT if the bytes are too many, no manifest or of another format, or if
/// name, size, depth or warnings are out of range.
absl::StatusOr<package::Manifest> parse_manifest(const std::string& bytes);

/// Returns INVALID_ARGUMENT: "scene package: <field>: <what is wrong>".
absl::Status manifest_error(const std::string& field, const std::string& what);

/// Returns the blob's digest and size. Returns INVALID_ARGUMENT naming `field` if the digest's
/// length or the size is out of range.
absl::StatusOr<BlobRef> blob_ref(const package::Blob& blob, const std::string& field);

}  // namespace bandsaw
