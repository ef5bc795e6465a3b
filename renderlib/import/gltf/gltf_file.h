#pragma once

// A glTF 2.0 file (.gltf or .glb) taken apart into its JSON and its binary chunk.

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw::gltf {

/// Largest file of a model that is read, and the most bytes that its buffers become.
inline constexpr std::uint64_t kMaxModelBytes = std::uint64_t{8} << 30;

struct GltfFile {
  std::string bytes;  ///< of the whole file
  Json root;
  std::optional<absl::string_view> binary;  ///< the binary chunk of a .glb; points into `bytes`

  GltfFile() = default;
  GltfFile(const GltfFile&) = delete;  ///< `binary` points into it
  GltfFile& operator=(const GltfFile&) = delete;
};

/// Reads the file into `to`. Returns false where it is of glTF 1; of a binary one `to` then has no
/// JSON.
/// INVALID_ARGUMENT: its container or its JSON is broken. Errors of the disk: as read_whole_file.
absl::StatusOr<bool> read_gltf_file(const std::string& path, GltfFile& to);

}  // namespace bandsaw::gltf
