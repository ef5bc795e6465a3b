#include "renderlib/import/model/gltf_json.h"

#include <google/protobuf/util/json_util.h>

#include <cstdint>
#include <cstring>

#include "absl/strings/match.h"
#include "absl/strings/string_view.h"
#include "renderlib/base/file.h"

namespace bandsaw::gltf {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{8} << 30;
/// More JSON than this is not searched: data URIs, mostly.
constexpr std::size_t kMostJson = std::size_t{256} << 20;

// The JSON of a .gltf, or the first chunk of a .glb (glTF 2.0, 4.4).
absl::string_view json_of(absl::string_view bytes) {
  if (!absl::StartsWith(bytes, "glTF")) {
    return bytes;
  }
  constexpr std::size_t kHeader = 20;
  std::uint32_t size = 0;
  if (bytes.size() < kHeader) {
    return {};
  }
  std::memcpy(&size, bytes.data() + 12, sizeof size);
  return bytes.substr(kHeader, size);
}

}  // namespace

std::optional<Struct> root_of(const std::string& path) {
  const auto bytes = read_whole_file(path, kMostBytes);
  absl::string_view json = bytes.ok() ? json_of(*bytes) : absl::string_view();
  while (absl::EndsWith(json, absl::string_view("\0", 1))) {
    json.remove_suffix(1);  // as some writers fill up the chunk
  }
  Struct root;
  if (json.empty() || json.size() > kMostJson ||
      !google::protobuf::util::JsonStringToMessage({json.data(), json.size()}, &root).ok()) {
    return std::nullopt;
  }
  return root;
}

const Value* find(const Struct& in, const std::string& name) {
  const auto found = in.fields().find(name);
  return found == in.fields().end() ? nullptr : &found->second;
}
const Struct* object(const Struct& in, const std::string& name) {
  const Value* value = find(in, name);
  return value != nullptr && value->has_struct_value() ? &value->struct_value() : nullptr;
}
const ListValue* list(const Struct& in, const std::string& name) {
  const Value* value = find(in, name);
  return value != nullptr && value->has_list_value() ? &value->list_value() : nullptr;
}
std::optional<double> number(const Struct& in, const std::string& name) {
  const Value* value = find(in, name);
  return value != nullptr && value->kind_case() == Value::kNumberValue
             ? std::optional(value->number_value())
             : std::nullopt;
}
const Struct* extension(const Struct& in, const std::string& name) {
  const Struct* extensions = object(in, "extensions");
  return extensions == nullptr ? nullptr : object(*extensions, name);
}

std::string name_in(const Struct& in) {
  const Value* called = find(in, "name");
  return called == nullptr ? "" : called->string_value();
}

const Struct* item(const Struct& root, const std::string& name, double index) {
  const ListValue* items = list(root, name);
  return items != nullptr && index >= 0 && index < items->values_size() &&
                 items->values(static_cast<int>(index)).has_struct_value()
             ? &items->values(static_cast<int>(index)).struct_value()
             : nullptr;
}

const Struct* item_of(const Struct& root, const std::string& name, const Struct& in,
                      const std::string& member) {
  return item(root, name, number(in, member).value_or(-1));
}

}  // namespace bandsaw::gltf
