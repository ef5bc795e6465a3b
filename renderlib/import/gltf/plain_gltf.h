#pragma once

// A glTF 2.0 file rewritten so that any reader understands it: attributes are floats, indices are
// 32-bit, nothing is sparse, compressed or outside of one buffer.

#include <cstddef>
#include <string>

#include "absl/status/statusor.h"
#include "renderlib/import/files/scene_folder.h"
#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw::gltf {

struct PlainGltf {
  /// Of glTF 1: it has not been rewritten, `root` is its JSON (empty of a binary file), the rest is
  /// empty.
  bool is_first_version = false;
  Json root;                   ///< refers to one buffer, whose uri is kPlainBuffer
  std::string buffer;          ///< its bytes
  std::size_t animations = 0;  ///< of the file; they are left out
};
inline constexpr char kPlainBuffer[] = "plain.bin";

/// Reads the model at `path` (real, below `scene`) and the buffers that it refers to. Images in
/// files stay in them; all others lie in the buffer. Left out: animations, tangents, attributes
/// that glTF does not define. All else keeps its place and number. INVALID_ARGUMENT: it is damaged,
/// or requires an extension that puts unreadable bytes in the place of vertices or images.
/// NOT_FOUND, PERMISSION_DENIED: a buffer's file. RESOURCE_EXHAUSTED: more than 8 GiB of vertices.
absl::StatusOr<PlainGltf> read_plain_gltf(const std::string& path, const SceneFolder& scene);

}  // namespace bandsaw::gltf
