#pragma once

// The bytes of a glTF file's buffers and buffer views.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/files/scene_folder.h"
#include "renderlib/import/gltf/gltf_file.h"

namespace bandsaw::gltf {

/// The bytes that a data URI holds (RFC 2397, base64 or percent-encoded); nothing if `uri` is none,
/// or its base64 is broken.
std::optional<std::string> data_of_uri(absl::string_view uri);

class Buffers {
 public:
  /// All outlive this. `folder` is that of the model, below the scene's.
  Buffers(const GltfFile& file, const SceneFolder& scene, std::string folder)
      : file_(file), scene_(scene), folder_(std::move(folder)) {}

  /// The bytes of bufferViews[index], decompressed, valid as long as this. `place` names what
  /// refers to it. INVALID_ARGUMENT: it does not exist or does not lie within its buffer.
  /// NOT_FOUND, PERMISSION_DENIED: the buffer's file.
  absl::StatusOr<absl::string_view> view(std::size_t index, absl::string_view place);

  /// Counts bytes that are about to be made. RESOURCE_EXHAUSTED: more than kMaxModelBytes in all.
  absl::Status take(std::uint64_t bytes, absl::string_view place);

 private:
  absl::StatusOr<absl::string_view> buffer(std::size_t index);
  absl::StatusOr<std::string> read_uri(const std::string& uri, const std::string& place);
  absl::StatusOr<std::string> decode(const Json& of, const Json& compressed,
                                     const std::string& place);
  absl::StatusOr<absl::string_view> slice(const Json& of, const std::string& place);

  const GltfFile& file_;
  const SceneFolder& scene_;
  std::string folder_;
  std::uint64_t taken_ = 0;
  std::map<std::size_t, std::string> buffers_;  ///< those that are not the binary chunk
  std::map<std::size_t, std::string> decoded_;  ///< buffer views that were compressed
};

}  // namespace bandsaw::gltf
