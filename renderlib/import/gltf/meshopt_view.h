#pragma once

// Decodes buffer views of EXT_meshopt_compression with libmeshoptimizer.

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw::gltf {

/// Checked parameters of a buffer view's extension.
struct MeshoptView {
  enum class Mode { kAttributes, kTriangles, kIndices } mode = Mode::kAttributes;
  enum class Filter { kNone, kOctahedral, kQuaternion, kExponential } filter = Filter::kNone;
  std::size_t count = 0;   ///< number of elements
  std::size_t stride = 0;  ///< bytes of an element, at most 256
  std::string place;       ///< prefix of messages

  std::size_t bytes() const { return count * stride; }
};

/// Reads the extension's object `of`; `bytes` is the byteLength of its buffer view. Returns
/// INVALID_ARGUMENT if a mode, filter, stride or count is invalid, or count times stride differs
/// from `bytes`.
absl::StatusOr<MeshoptView> meshopt_view(const Json& of, std::size_t bytes, std::string place);

/// Returns the decoded elements, view.bytes() bytes. Returns INVALID_ARGUMENT if the stream is
/// damaged.
absl::StatusOr<std::string> decode_meshopt(const MeshoptView& view, absl::string_view stream);

}  // namespace bandsaw::gltf
