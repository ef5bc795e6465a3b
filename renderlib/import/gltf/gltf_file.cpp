// Reads a .gltf or .glb file: its JSON, and the binary chunk if it has one.

#include "renderlib/import/gltf/gltf_file.h"

#include <cstdint>
#include <cstring>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::gltf {
namespace {

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN" and a zero

std::uint32_t number_at(absl::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

struct Chunk {
  std::uint32_t type = 0;
  absl::string_view bytes;
};

/// Removes the next chunk (glTF 2.0, 4.4.3) from the front of `rest`.
absl::StatusOr<Chunk> take_chunk(absl::string_view& rest) {
  const std::size_t left = rest.size();
  const std::uint32_t size = left < kChunkHeaderBytes ? 0 : number_at(rest, 0);
  if (left < kChunkHeaderBytes || size > left - kChunkHeaderBytes) {
    return damaged("its chunks", absl::StrCat("a chunk of ", size, " bytes begins ", left,
                                              " bytes before the end of the file"));
  }
  const Chunk chunk{number_at(rest, 4), rest.substr(kChunkHeaderBytes, size)};
  rest.remove_prefix(kChunkHeaderBytes + size);
  return chunk;
}

/// Returns the JSON chunk of the .glb file in `file.bytes`, and sets `file.binary` to its binary
/// chunk if there is one.
absl::StatusOr<absl::string_view> take_apart(GltfFile& file) {
  absl::string_view rest = absl::string_view(file.bytes).substr(kHeaderBytes);
  ASSIGN_OR_RETURN(const Chunk json, take_chunk(rest));
  if (json.type != kJsonChunk) {
    return damaged("its chunks", "the first one is not JSON");
  }
  // Bytes that are too few for another chunk's header are padding.
  if (rest.size() >= kChunkHeaderBytes) {
    ASSIGN_OR_RETURN(const Chunk next, take_chunk(rest));
    if (next.type == kBinaryChunk) {
      file.binary = next.bytes;
    }
  }
  return json.bytes;
}

/// Returns true for glTF 1.0 and 1.0.1; some writers store the version as a number.
bool is_first_version(const Json& root) {
  const Json* asset = object(root, "asset");
  return asset != nullptr && (absl::StartsWith(text(*asset, "version"), "1") ||
                              number(*asset, "version").value_or(0) == 1);
}

}  // namespace

absl::StatusOr<bool> read_gltf_file(const std::string& path, GltfFile& to) {
  ASSIGN_OR_RETURN(to.bytes, read_whole_file(path, kMaxModelBytes));
  absl::string_view json = to.bytes;
  to.root = Json::object();
  if (absl::StartsWith(to.bytes, "glTF")) {
    if (to.bytes.size() < kHeaderBytes) {
      return damaged("its header", absl::StrCat("the file has ", to.bytes.size(), " bytes"));
    }
    if (number_at(to.bytes, 4) == 1) {
      return false;
    }
    ASSIGN_OR_RETURN(json, take_apart(to));
  }
  while (absl::EndsWith(json, absl::string_view("\0", 1))) {
    json.remove_suffix(1);  // some writers pad the chunk with zeros
  }
  ASSIGN_OR_RETURN(to.root, parse_json(json));
  return !is_first_version(to.root);
}

}  // namespace bandsaw::gltf
