#pragma once

// Checks a glTF file before it is rewritten (plain_gltf.h), so that later code can follow the
// checked indices without a check of its own.

#include "absl/status/status.h"
#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw::gltf {

/// Checks the indices by which nodes, scenes, skins, textures, images, materials and primitives of
/// meshes refer to other objects. The indices of accessors in meshes are checked only when the
/// meshes are read. The indices in accessors, buffer views and animations are checked only when
/// these objects are read. Also checks that the nodes form trees of at most 1,000 levels that
/// contain each node at most once. Returns INVALID_ARGUMENT:
/// "nodes[3].mesh: meshes[7] does not exist, …".
absl::Status check_references(const Json& root);

}  // namespace bandsaw::gltf
