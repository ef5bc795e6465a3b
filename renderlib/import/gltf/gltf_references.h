#pragma once

// Checks a glTF file before it is rewritten (plain_gltf.h), so that later code can follow every
// index without a check.

#include "absl/status/status.h"
#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw::gltf {

/// Checks every index by which an object of the file refers to another one, except accessors of
/// meshes, and that the nodes form trees of at most 1,000 levels that contain each node at most
/// once. Returns INVALID_ARGUMENT: "nodes[3].mesh: meshes[7] does not exist, …".
absl::Status check_references(const Json& root);

}  // namespace bandsaw::gltf
