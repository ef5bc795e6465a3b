#pragma once

// Reads accessors of a glTF file as plain numbers. Accessors may be of any component type,
// normalised or not, strided or sparse. An accessor without a buffer view holds zeros. The numbers
// are used to rewrite the file (plain_gltf.h) and to read its animations.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "absl/types/span.h"
#include "renderlib/import/gltf/gltf_buffers.h"

namespace bandsaw::gltf {

/// glTF's componentType.
enum class Component : int {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
};

/// Checked description of an accessor's elements, without their location.
struct AccessorShape {
  std::string place;  ///< names the accessor in messages: "accessors[3]"
  Component component = Component::kFloat;
  bool normalized = false;
  std::size_t components = 1;  ///< 3 for a VEC3, 16 for a MAT4
  std::size_t count = 0;       ///< number of elements, at most 2^31

  std::size_t values() const { return count * components; }
};

/// Returns the shape of an accessor. `place` names the referring object in messages. Returns
/// INVALID_ARGUMENT if there is no such accessor, or if its type, component type or count is not
/// valid in glTF 2.0.
absl::StatusOr<AccessorShape> accessor_shape(const Json& root, std::size_t index,
                                             absl::string_view place);

/// Returns the value of a component; normalised integers are converted by the formulas of glTF 2.0,
/// 3.6.2.2.
float value_of(std::int64_t component, Component type, bool normalized);

/// Returns all components of all elements of accessor number `index`, whose shape is `shape`.
/// Integers are converted by value_of(). Returns INVALID_ARGUMENT if the elements are not within
/// their buffer view, or if a sparse index is not below the count. Returns RESOURCE_EXHAUSTED if
/// the model would need too much memory (Buffers::take).
absl::StatusOr<std::vector<float>> read_floats(const Json& root, std::size_t index,
                                               const AccessorShape& shape, Buffers& buffers);

/// Does the same as read_floats() for accessors of unsigned integers, which hold indices or joints.
/// Returns INVALID_ARGUMENT also for floats and signed integers.
absl::StatusOr<std::vector<std::uint32_t>> read_whole_numbers(const Json& root, std::size_t index,
                                                              const AccessorShape& shape,
                                                              Buffers& buffers);

}  // namespace bandsaw::gltf
