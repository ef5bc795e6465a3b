#pragma once

// Buffer views of EXT_meshopt_compression, decoded by libmeshoptimizer.

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw::gltf {

/// What the extension of a buffer view says, checked.
struct MeshoptView {
  enum class Mode { kAttributes, kTriangles, kIndices } mode = Mode::kAttributes;
  enum class Filter { kNone, kOctahedral, kQuaternion, kExponential } filter = Filter::kNone;
  std::size_t count = 0;   ///< elements
  std::size_t stride = 0;  ///< bytes of an element, at most 256
  std::string place;       ///< begins messages

  std::size_t bytes() const { return count * stride; }
};

/// `of` is the extension's object, `bytes` the byteLength of the buffer view that bears it.
/// INVALID_ARGUMENT: a mode, filter, stride or count is not one of the extension, or count times
/// stride is not `bytes`.
absl::StatusOr<MeshoptView> meshopt_view(const Json& of, std::size_t bytes, std::string place);

/// The decoded elements: view.bytes() bytes. INVALID_ARGUMENT: the stream is damaged.
absl::StatusOr<std::string> decode_meshopt(const MeshoptView& view, absl::string_view stream);

}  // namespace bandsaw::gltf
