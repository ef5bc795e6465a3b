#pragma once

// Rewrites a glTF 2.0 file so that any reader understands it. In the result, attributes are floats,
// except for joints, which are 16-bit integers, and indices have 32 bits. All arrays lie in one
// buffer, and none is sparse or compressed. model/model.cpp lets Assimp read the result.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/animation/animation.h"
#include "renderlib/import/files/scene_folder.h"
#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw::gltf {

struct PlainGltf {
  /// True for glTF 1, which is not rewritten. Then `root` is the JSON of the file, or empty for a
  /// binary file, and all other members are empty.
  bool is_first_version = false;
  Json root;                                 ///< refers to one buffer, whose uri is kPlainBuffer
  std::string buffer;                        ///< bytes of that buffer
  std::vector<std::string> animation_names;  ///< of all animations of the file
  /// The chosen animation; its nodes are keyed by their index in the file.
  std::optional<Animation> animation;
};
inline constexpr char kPlainBuffer[] = "plain.bin";

/// Reads the model at `path`, a real path below `scene`, and the buffers to which it refers.
///
/// Images that are files of their own stay files. All other images that textures use are moved to
/// the buffer. An image that no texture uses stays in the list without its bytes, so that later
/// images keep their numbers. Animations other than the chosen one, tangents and attributes that
/// glTF does not define are omitted.
///
/// In the result each mesh has one pose. If several nodes pose a mesh differently, by skins or
/// weights of morph targets, the mesh is copied to the end of the list for each pose after the
/// first. The weights of a node become those of its mesh. Everything else keeps its place and
/// number.
///
/// Returns NOT_FOUND if the file does not have the chosen animation. Returns INVALID_ARGUMENT if
/// the file is damaged, or requires an extension for vertices or images that is not supported.
/// Returns NOT_FOUND or PERMISSION_DENIED for a buffer's file, and RESOURCE_EXHAUSTED for more than
/// 8 GiB of buffers and decoded arrays.
absl::StatusOr<PlainGltf> read_plain_gltf(const std::string& path, const SceneFolder& scene,
                                          const AnimationChoice& choice = {});

}  // namespace bandsaw::gltf
