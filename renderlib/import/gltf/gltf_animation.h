#pragma once

// Reads animations of a glTF 2.0 file. All interpolations of glTF are supported, and the values of
// keys may have any component type.

#include <cstddef>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/animation/animation.h"
#include "renderlib/import/gltf/gltf_buffers.h"
#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw::gltf {

/// Returns the names of the file's animations, in the order of the file. A name may be empty, and
/// several animations may have the same name.
std::vector<std::string> animation_names(const Json& root);

/// Returns animation number `index`, which MUST exist. Its nodes are keyed by their index in the
/// file. Channels without a node, or with a path that glTF does not define, have no effect (glTF
/// 2.0, 3.11). Returns INVALID_ARGUMENT if times do not increase or are beyond 1e9 s, if a number
/// is not finite, or if the number of values does not match the number of times.
absl::StatusOr<Animation> read_animation(const Json& root, std::size_t index, Buffers& buffers);

}  // namespace bandsaw::gltf
