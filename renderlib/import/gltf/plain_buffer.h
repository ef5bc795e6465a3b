#pragma once

// Builds the single buffer of a plain glTF document, which any reader of glTF understands
// (plain_gltf.h): the bytes of the document's arrays, and the accessors and buffer views that say
// where each array is and of what type.

#include <cstdint>
#include <string>

#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw::gltf {

class PlainBuffer {
 public:
  /// Each function add() appends a copy of the values and returns the number of a new accessor for
  /// the copy. An element has `components` values: 1 to 4, or 16 for a matrix. An element of 32-bit
  /// integers has one.
  std::size_t add(absl::Span<const float> values, std::size_t components);
  std::size_t add(absl::Span<const std::uint16_t> values, std::size_t components);
  std::size_t add(absl::Span<const std::uint32_t> values);
  /// Appends a copy of the bytes and returns the number of a new buffer view for the copy.
  std::size_t add_bytes(absl::string_view bytes);

  /// Adds accessors, buffer views and the buffer with the name `uri` to `root`, and returns the
  /// buffer's bytes. May be called once.
  std::string finish(const std::string& uri, Json& root);

 private:
  /// Appends the bytes and returns the number of a new accessor of `count` elements for them.
  /// `component` is glTF's componentType.
  std::size_t add_accessor(absl::string_view bytes, int component, std::size_t components,
                           std::size_t count);

  std::string bytes_;
  Json views_ = Json::array();
  Json accessors_ = Json::array();
};

}  // namespace bandsaw::gltf
