#pragma once

// Gives access to the bytes of a glTF file's buffers and buffer views, and limits their total size.

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

/// Returns the bytes of a data URI (RFC 2397, base64 or percent-encoded). Returns std::nullopt if
/// `uri` is not a data URI or if its base64 is broken.
std::optional<std::string> data_of_uri(absl::string_view uri);

class Buffers {
 public:
  /// `file` and `scene` MUST outlive this object. `folder` is the folder of the model, which is the
  /// scene's folder or lies below it.
  Buffers(const GltfFile& file, const SceneFolder& scene, std::string folder)
      : file_(file), scene_(scene), folder_(std::move(folder)) {}

  /// Returns the decompressed bytes of bufferViews[index], valid as long as this object. `place`
  /// names the referring object in messages. Returns INVALID_ARGUMENT if the view does not exist or
  /// is not within its buffer, and NOT_FOUND or PERMISSION_DENIED for the buffer's file.
  absl::StatusOr<absl::string_view> view(std::size_t index, absl::string_view place);

  /// Counts bytes that are about to be allocated. Returns RESOURCE_EXHAUSTED if the sum of all
  /// calls would exceed kMaxModelBytes.
  absl::Status take(std::uint64_t bytes, absl::string_view place);

 private:
  // Steps of view(), described at their definitions.
  absl::StatusOr<absl::string_view> buffer(std::size_t index);
  absl::StatusOr<std::string> read_uri(const std::string& uri, const std::string& place);
  absl::StatusOr<std::string> decode(const Json& of, const Json& compressed,
                                     const std::string& place);
  absl::StatusOr<absl::string_view> slice(const Json& of, const std::string& place);

  const GltfFile& file_;
  const SceneFolder& scene_;
  std::string folder_;
  std::uint64_t taken_ = 0;                     ///< sum of the bytes that take() has counted
  std::map<std::size_t, std::string> buffers_;  ///< buffers other than the binary chunk
  std::map<std::size_t, std::string> decoded_;  ///< buffer views that were compressed
};

}  // namespace bandsaw::gltf
