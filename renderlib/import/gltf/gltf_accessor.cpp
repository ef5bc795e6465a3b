// Reads accessors of a glTF file: checks that the elements lie within their buffer view, reads them
// one component at a time, and applies sparse replacements.

#include "renderlib/import/gltf/gltf_accessor.h"

#include <algorithm>
#include <cstring>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::gltf {
namespace {

constexpr std::size_t kMaxElements = std::size_t{1} << 31;
constexpr std::size_t kMaxStride = 252;  ///< glTF 2.0, 5.11.4

/// Returns the bytes of a component; 0 for an unknown type.
std::size_t size_of(Component type) {
  switch (type) {
    case Component::kByte:
    case Component::kUnsignedByte:
      return 1;
    case Component::kShort:
    case Component::kUnsignedShort:
      return 2;
    case Component::kUnsignedInt:
    case Component::kFloat:
      return 4;
  }
  return 0;
}

/// Returns the number of components of an accessor's type; 0 for a type that is not supported.
std::size_t components_of(absl::string_view type) {
  return type == "SCALAR" ? 1
         : type == "VEC2" ? 2
         : type == "VEC3" ? 3
         : type == "VEC4" ? 4
         : type == "MAT4" ? 16
                          : 0;
}

template <class T>
T load(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// Returns the component at `from`, which must be of an integer type.
std::int64_t load_integer(const char* from, Component type) {
  switch (type) {
    case Component::kByte:
      return load<std::int8_t>(from);
    case Component::kUnsignedByte:
      return load<std::uint8_t>(from);
    case Component::kShort:
      return load<std::int16_t>(from);
    case Component::kUnsignedShort:
      return load<std::uint16_t>(from);
    default:
      return load<std::uint32_t>(from);
  }
}

// These two functions set `to` to the component at `from`.
void convert(const char* from, const AccessorShape& shape, float& to) {
  to = shape.component == Component::kFloat
           ? load<float>(from)
           : value_of(load_integer(from, shape.component), shape.component, shape.normalized);
}
void convert(const char* from, const AccessorShape& shape, std::uint32_t& to) {
  to = static_cast<std::uint32_t>(load_integer(from, shape.component));
}

/// Elements in a buffer view.
struct Elements {
  absl::string_view bytes;  ///< beginning with the first element
  std::size_t stride = 0;
  const char* at(std::size_t i) const { return bytes.data() + i * stride; }
};

/// Returns `count` elements of `element_bytes` bytes each. They lie in the buffer view number
/// `in.bufferView` and begin at its byte `in.byteOffset`. Returns INVALID_ARGUMENT if the stride of
/// the view is not valid or the elements do not lie within the view.
absl::StatusOr<Elements> elements_of(const Json& root, const Json& in, const std::string& place,
                                     std::size_t count, std::size_t element_bytes,
                                     Buffers& buffers) {
  ASSIGN_OR_RETURN(const std::size_t view, whole_of(in, "bufferView", place));
  ASSIGN_OR_RETURN(const std::size_t offset, whole_of(in, "byteOffset", place, 0));
  ASSIGN_OR_RETURN(const absl::string_view bytes, buffers.view(view, place));
  ASSIGN_OR_RETURN(const std::size_t stride,
                   whole_of(*item(root, "bufferViews", static_cast<double>(view)), "byteStride",
                            absl::StrCat("bufferViews[", view, "]"), element_bytes));
  if (stride < element_bytes || (stride > kMaxStride && stride != element_bytes)) {
    return damaged(absl::StrCat("bufferViews[", view, "].byteStride"),
                   absl::StrCat("is ", stride, ", must lie in [", element_bytes, ", ", kMaxStride,
                                "] for ", place));
  }
  // No overflow: count <= 2^31, stride < 2^8.
  const std::size_t needed = count == 0 ? 0 : (count - 1) * stride + element_bytes;
  if (offset > bytes.size() || needed > bytes.size() - offset) {
    return damaged(
        place, absl::StrCat("needs ", needed, " bytes from byte ", offset, " of bufferViews[", view,
                            "], which has ", bytes.size(), " bytes"));
  }
  return Elements{bytes.substr(offset), stride};
}

/// Replaces the elements to which the accessor's `sparse` refers (glTF 2.0, 3.6.2.3).
template <class T>
absl::Status replace_sparse(const Json& root, const Json& sparse, const AccessorShape& shape,
                            Buffers& buffers, std::vector<T>& values) {
  const std::string place = shape.place + ".sparse";
  const Json* indices = object(sparse, "indices");
  const Json* with = object(sparse, "values");
  ASSIGN_OR_RETURN(const std::size_t count, whole_of(sparse, "count", place));
  if (indices == nullptr || with == nullptr || count > shape.count) {
    return damaged(place, "has no indices or no values, or a count above that of the accessor");
  }
  ASSIGN_OR_RETURN(const std::size_t type, whole_of(*indices, "componentType", place));
  const Component component = static_cast<Component>(type);
  if (component != Component::kUnsignedByte && component != Component::kUnsignedShort &&
      component != Component::kUnsignedInt) {
    return damaged(place, absl::StrCat("componentType of its indices is ", type));
  }
  const std::size_t size = size_of(shape.component);
  ASSIGN_OR_RETURN(const Elements places, elements_of(root, *indices, place + ".indices", count,
                                                      size_of(component), buffers));
  ASSIGN_OR_RETURN(const Elements from, elements_of(root, *with, place + ".values", count,
                                                    size * shape.components, buffers));
  for (std::size_t i = 0; i < count; ++i) {
    const auto element = static_cast<std::size_t>(load_integer(places.at(i), component));
    if (element >= shape.count) {
      return damaged(place, absl::StrCat("replaces element ", element,
                                         "; the number of elements is ", shape.count));
    }
    for (std::size_t c = 0; c < shape.components; ++c) {
      convert(from.at(i) + c * size, shape, values[element * shape.components + c]);
    }
  }
  return absl::OkStatus();
}

/// Returns all components of accessor number `index`, which MUST exist, converted to T.
template <class T>
absl::StatusOr<std::vector<T>> read_as(const Json& root, std::size_t index,
                                       const AccessorShape& shape, Buffers& buffers) {
  const Json& accessor = *item(root, "accessors", static_cast<double>(index));
  const std::size_t size = size_of(shape.component);
  Elements elements;
  const bool has_view = find(accessor, "bufferView") != nullptr;
  if (has_view) {
    ASSIGN_OR_RETURN(elements, elements_of(root, accessor, shape.place, shape.count,
                                           size * shape.components, buffers));
  }
  RETURN_IF_ERROR(buffers.take(shape.values() * sizeof(T), shape.place));
  std::vector<T> values(shape.values());
  for (std::size_t i = 0; has_view && i < shape.count; ++i) {
    for (std::size_t c = 0; c < shape.components; ++c) {
      convert(elements.at(i) + c * size, shape, values[i * shape.components + c]);
    }
  }
  if (const Json* sparse = object(accessor, "sparse")) {
    RETURN_IF_ERROR(replace_sparse(root, *sparse, shape, buffers, values));
  }
  return values;
}

}  // namespace

absl::StatusOr<AccessorShape> accessor_shape(const Json& root, std::size_t index,
                                             absl::string_view place) {
  const Json* accessor = item(root, "accessors", static_cast<double>(index));
  if (accessor == nullptr) {
    return damaged(place, absl::StrCat("accessors[", index, "] does not exist"));
  }
  AccessorShape shape;
  shape.place = absl::StrCat("accessors[", index, "]");
  ASSIGN_OR_RETURN(const std::size_t type, whole_of(*accessor, "componentType", shape.place));
  shape.component = static_cast<Component>(std::min<std::size_t>(type, 1 << 16));
  if (size_of(shape.component) == 0) {
    return damaged(shape.place, absl::StrCat("componentType is ", type));
  }
  shape.components = components_of(text(*accessor, "type"));
  if (shape.components == 0) {
    return damaged(shape.place, absl::StrCat("type is \"", text(*accessor, "type"),
                                             "\", must be SCALAR, VEC2, VEC3, VEC4 or MAT4"));
  }
  ASSIGN_OR_RETURN(shape.count, whole_of(*accessor, "count", shape.place));
  if (shape.count > kMaxElements) {
    return damaged(shape.place,
                   absl::StrCat("count is ", shape.count, ", at most ", kMaxElements, " are read"));
  }
  const Json* normalized = find(*accessor, "normalized");
  shape.normalized = normalized != nullptr && normalized->is_boolean() && normalized->get<bool>();
  return shape;
}

float value_of(std::int64_t component, Component type, bool normalized) {
  const float value = static_cast<float>(component);
  if (!normalized) {
    return value;
  }
  switch (type) {
    case Component::kByte:
      return std::max(value / 127.0f, -1.0f);
    case Component::kUnsignedByte:
      return value / 255.0f;
    case Component::kShort:
      return std::max(value / 32767.0f, -1.0f);
    case Component::kUnsignedShort:
      return value / 65535.0f;
    default:
      return value;
  }
}

absl::StatusOr<std::vector<float>> read_floats(const Json& root, std::size_t index,
                                               const AccessorShape& shape, Buffers& buffers) {
  return read_as<float>(root, index, shape, buffers);
}

absl::StatusOr<std::vector<std::uint32_t>> read_whole_numbers(const Json& root, std::size_t index,
                                                              const AccessorShape& shape,
                                                              Buffers& buffers) {
  if (shape.component != Component::kUnsignedByte && shape.component != Component::kUnsignedShort &&
      shape.component != Component::kUnsignedInt) {
    return damaged(shape.place, absl::StrCat("componentType is ", static_cast<int>(shape.component),
                                             ", must be an unsigned integer"));
  }
  return read_as<std::uint32_t>(root, index, shape, buffers);
}

}  // namespace bandsaw::gltf
