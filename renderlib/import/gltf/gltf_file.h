#pragma once

// Splits a glTF 2.0 file (.gltf or .glb) into its JSON and its binary chunk.

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw::gltf {

/// Maximum size of a model's file, and of its decoded buffers in total.
inline constexpr std::uint64_t kMaxModelBytes = std::uint64_t{8} << 30;

struct GltfFile {
  std::string bytes;  ///< the whole file
  Json root;
  std::optional<absl::string_view> binary;  ///< the binary chunk of a .glb; points into `bytes`

  GltfFile() = default;
  GltfFile(const GltfFile&) = delete;  ///< `binary` points into `bytes`
  GltfFile& operator=(const GltfFile&) = delete;
};

/// Reads the file into `to`. Returns true, or false if the file is glTF 1. For a binary file of
/// glTF 1, `to.root` is an empty object. Returns INVALID_ARGUMENT if the container or the JSON is
/// broken, and the errors of read_whole_file().
absl::StatusOr<bool> read_gltf_file(const std::string& path, GltfFile& to);

}  // namespace bandsaw::gltf
