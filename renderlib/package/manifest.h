#pragma once

// Parsing of manifests (the messages that describe scene packages, proto/package.proto). Does all
// checks for which the blobs (flat arrays, which a manifest names by their digests) are not needed.

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/package/package.h"

namespace bandsaw {

/// Parses a manifest and checks it. Returns INVALID_ARGUMENT
/// - if there are more than wire::kManifestBytes bytes,
/// - if the bytes are no manifest, or a manifest of another format,
/// - if the name, the image size, the depth, another setting or a text is out of range,
/// - or if there are more shapes than a BVH can hold.
absl::StatusOr<package::Manifest> parse_manifest(const std::string& bytes);

/// Makes the error INVALID_ARGUMENT "scene package: <field>: <what is wrong>".
absl::Status manifest_error(const std::string& field, const std::string& what);

/// Returns the blob's digest and size. Returns INVALID_ARGUMENT, which names `field`, if the digest
/// has a wrong length or the size is above the limit.
absl::StatusOr<BlobRef> blob_ref(const package::Blob& blob, const std::string& field);

}  // namespace bandsaw
