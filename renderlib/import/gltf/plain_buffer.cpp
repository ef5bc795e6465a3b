// Collects the arrays of the rewritten glTF document (plain_gltf.h) in one buffer, and their
// accessors and buffer views in JSON.

#include "renderlib/import/gltf/plain_buffer.h"

#include <utility>

#include "renderlib/import/gltf/gltf_accessor.h"

namespace bandsaw::gltf {
namespace {

template <class T>
absl::string_view bytes_of(absl::Span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// Returns glTF's type of an element with 1 to 4 components, or with 16 (a matrix).
const char* type_of(std::size_t components) {
  return components == 1   ? "SCALAR"
         : components == 2 ? "VEC2"
         : components == 3 ? "VEC3"
         : components == 4 ? "VEC4"
                           : "MAT4";
}

}  // namespace

std::size_t PlainBuffer::add_bytes(absl::string_view bytes) {
  constexpr std::size_t kAlignment = 4;
  bytes_.resize((bytes_.size() + kAlignment - 1) / kAlignment * kAlignment);
  views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}});
  bytes_.append(bytes.data(), bytes.size());
  return views_.size() - 1;
}

std::size_t PlainBuffer::add_accessor(absl::string_view bytes, int component,
                                      std::size_t components, std::size_t count) {
  const std::size_t view = add_bytes(bytes);
  accessors_.push_back({{"bufferView", view},
                        {"componentType", component},
                        {"type", type_of(components)},
                        {"count", count}});
  return accessors_.size() - 1;
}

std::size_t PlainBuffer::add(absl::Span<const float> values, std::size_t components) {
  return add_accessor(bytes_of(values), static_cast<int>(Component::kFloat), components,
                      values.size() / components);
}
std::size_t PlainBuffer::add(absl::Span<const std::uint16_t> values, std::size_t components) {
  return add_accessor(bytes_of(values), static_cast<int>(Component::kUnsignedShort), components,
                      values.size() / components);
}
std::size_t PlainBuffer::add(absl::Span<const std::uint32_t> values) {
  return add_accessor(bytes_of(values), static_cast<int>(Component::kUnsignedInt), 1,
                      values.size());
}

std::string PlainBuffer::finish(const std::string& uri, Json& root) {
  root["accessors"] = std::move(accessors_);
  root["bufferViews"] = std::move(views_);
  root["buffers"] = Json::array({{{"uri", uri}, {"byteLength", bytes_.size()}}});
  return std::move(bytes_);
}

}  // namespace bandsaw::gltf
