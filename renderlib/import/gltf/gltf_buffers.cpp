// Reads the buffers of a glTF file. A buffer is the binary chunk, a data URI or a file, and is read
// when it is first used. A compressed buffer view is decoded when it is first used.

#include "renderlib/import/gltf/gltf_buffers.h"

#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/files/percent.h"
#include "renderlib/import/gltf/meshopt_view.h"

namespace bandsaw::gltf {
namespace {

constexpr char kMeshopt[] = "EXT_meshopt_compression";

}  // namespace

std::optional<std::string> data_of_uri(absl::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (!absl::StartsWithIgnoreCase(uri, "data:") || comma == absl::string_view::npos) {
    return std::nullopt;
  }
  const absl::string_view data = uri.substr(comma + 1);
  if (!absl::EndsWithIgnoreCase(uri.substr(0, comma), ";base64")) {
    return percent_decoded(data);
  }
  std::string bytes;
  return absl::Base64Unescape(data, &bytes) ? std::optional(std::move(bytes)) : std::nullopt;
}

absl::Status Buffers::take(std::uint64_t bytes, absl::string_view place) {
  if (bytes > kMaxModelBytes - taken_) {
    return absl::ResourceExhaustedError(
        absl::StrCat(place, ": needs ", bytes, " bytes more; a model's buffers may take ",
                     kMaxModelBytes, " in all: split the model into several files"));
  }
  taken_ += bytes;
  return absl::OkStatus();
}

/// Returns the bytes of a data URI, or of the file that `uri` names. The name is percent-decoded.
/// If there is no file of the decoded name, `uri` itself is tried as the name.
absl::StatusOr<std::string> Buffers::read_uri(const std::string& uri, const std::string& place) {
  if (absl::StartsWithIgnoreCase(uri, "data:")) {
    RETURN_IF_ERROR(take(uri.size(), place));
    auto data = data_of_uri(uri);
    if (!data) {
      return damaged(absl::StrCat(place, ".uri"), "its base64 is broken");
    }
    return *std::move(data);
  }
  auto path = scene_.resolve(percent_decoded(uri), folder_);
  if (absl::IsNotFound(path.status())) {
    path = scene_.resolve(uri, folder_);
  }
  if (absl::IsNotFound(path.status())) {
    return absl::NotFoundError(absl::StrCat("its file \"", uri, "\" is missing"));
  }
  RETURN_IF_ERROR(path.status());
  ASSIGN_OR_RETURN(std::string bytes, read_whole_file(*path, kMaxModelBytes - taken_));
  RETURN_IF_ERROR(take(bytes.size(), place));
  return bytes;
}

/// Returns the first `byteLength` bytes of buffers[index].
absl::StatusOr<absl::string_view> Buffers::buffer(std::size_t index) {
  const std::string place = absl::StrCat("buffers[", index, "]");
  const Json* of = item(file_.root, "buffers", static_cast<double>(index));
  if (of == nullptr) {
    return damaged(place, "does not exist");
  }
  ASSIGN_OR_RETURN(const std::size_t size, whole_of(*of, "byteLength", place));
  absl::string_view bytes;
  if (find(*of, "uri") == nullptr) {
    if (index != 0 || !file_.binary) {
      return damaged(place, "has no uri, and the file has no binary chunk for it");
    }
    bytes = *file_.binary;
  } else {
    auto known = buffers_.find(index);
    if (known == buffers_.end()) {
      ASSIGN_OR_RETURN(std::string read, read_uri(text(*of, "uri"), place));
      known = buffers_.emplace(index, std::move(read)).first;
    }
    bytes = known->second;
  }
  if (size > bytes.size()) {
    return damaged(place, absl::StrCat("byteLength is ", size, ", but the buffer has ",
                                       bytes.size(), " bytes"));
  }
  return bytes.substr(0, size);
}

/// Returns the range of the buffer `of.buffer` given by `of.byteOffset` and `of.byteLength`.
absl::StatusOr<absl::string_view> Buffers::slice(const Json& of, const std::string& place) {
  ASSIGN_OR_RETURN(const std::size_t number, whole_of(of, "buffer", place));
  ASSIGN_OR_RETURN(const std::size_t offset, whole_of(of, "byteOffset", place, 0));
  ASSIGN_OR_RETURN(const std::size_t size, whole_of(of, "byteLength", place));
  ASSIGN_OR_RETURN(const absl::string_view bytes, buffer(number));
  if (offset > bytes.size() || size > bytes.size() - offset) {
    return damaged(place, absl::StrCat("ends at byte ", offset + size, " of buffers[", number,
                                       "], which has ", bytes.size(), " bytes"));
  }
  return bytes.substr(offset, size);
}

/// Returns the decoded bytes of the buffer view `of`, whose extension object is `compressed`.
absl::StatusOr<std::string> Buffers::decode(const Json& of, const Json& compressed,
                                            const std::string& place) {
  ASSIGN_OR_RETURN(const std::size_t size, whole_of(of, "byteLength", place));
  const std::string own_place = absl::StrCat(place, ".", kMeshopt);
  ASSIGN_OR_RETURN(const MeshoptView view, meshopt_view(compressed, size, own_place));
  ASSIGN_OR_RETURN(const absl::string_view stream, slice(compressed, own_place));
  RETURN_IF_ERROR(take(view.bytes(), place));
  return decode_meshopt(view, stream);
}

absl::StatusOr<absl::string_view> Buffers::view(std::size_t index, absl::string_view place) {
  const Json* of = item(file_.root, "bufferViews", static_cast<double>(index));
  if (of == nullptr) {
    return damaged(place, absl::StrCat("bufferViews[", index, "] does not exist"));
  }
  const std::string own_place = absl::StrCat("bufferViews[", index, "]");
  const Json* compressed = extension(*of, kMeshopt);
  if (compressed == nullptr) {
    return slice(*of, own_place);
  }
  auto known = decoded_.find(index);
  if (known == decoded_.end()) {
    ASSIGN_OR_RETURN(std::string bytes, decode(*of, *compressed, own_place));
    known = decoded_.emplace(index, std::move(bytes)).first;
  }
  return known->second;
}

}  // namespace bandsaw::gltf
