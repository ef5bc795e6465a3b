// Parses the JSON of a glTF file, and looks up its members. Size and nesting of the text are
// limited before it is parsed, because nlohmann's parser and destructors are recursive.

#include "renderlib/import/gltf/gltf_json.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"

namespace bandsaw::gltf {
namespace {

/// Maximum size of the JSON, which includes buffers in data URIs.
constexpr std::size_t kMaxJsonBytes = std::size_t{256} << 20;
/// Maximum nesting depth. It is limited because the functions that traverse the JSON, in this
/// folder and in the library, are recursive.
constexpr int kMaxDepth = 100;

/// Returns the nesting depth of brackets outside of strings.
int depth_of(absl::string_view text) {
  int depth = 0;
  int deepest = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      i += c == '\\' ? 1 : 0;
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++depth);
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return deepest;
}

}  // namespace

absl::StatusOr<Json> parse_json(absl::string_view text) {
  if (text.size() > kMaxJsonBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat("its JSON has ", text.size(), " bytes, at most ", kMaxJsonBytes,
                     " are read; put its buffers into files beside it"));
  }
  if (depth_of(text) > kMaxDepth) {
    return absl::InvalidArgumentError(absl::StrCat("its JSON is nested deeper than ", kMaxDepth,
                                                   " levels, which glTF never needs"));
  }
  try {
    Json root = Json::parse(text.begin(), text.end());
    if (!root.is_object()) {
      return damaged("its JSON", "is not an object");
    }
    return root;
  } catch (const Json::parse_error& error) {
    return damaged("its JSON", absl::StrCat("is broken at byte ", error.byte));
  } catch (const Json::exception&) {
    return damaged("its JSON", "holds a number that is too large");
  }
}

absl::Status damaged(absl::string_view place, absl::string_view what) {
  return absl::InvalidArgumentError(
      absl::StrCat(place, ": ", what, "; the file is damaged: export it again"));
}

const Json* find(const Json& in, absl::string_view name) {
  if (!in.is_object()) {
    return nullptr;
  }
  const auto found = in.find(std::string(name));
  return found == in.end() ? nullptr : &*found;
}
const Json* object(const Json& in, absl::string_view name) {
  const Json* value = find(in, name);
  return value != nullptr && value->is_object() ? value : nullptr;
}
const Json* list(const Json& in, absl::string_view name) {
  const Json* value = find(in, name);
  return value != nullptr && value->is_array() ? value : nullptr;
}
const Json& items(const Json& in, absl::string_view name) {
  static const Json kNone = Json::array();
  const Json* value = list(in, name);
  return value == nullptr ? kNone : *value;
}
std::optional<double> number(const Json& in, absl::string_view name) {
  const Json* value = find(in, name);
  return value != nullptr && value->is_number() ? std::optional(value->get<double>())
                                                : std::nullopt;
}
std::string text(const Json& in, absl::string_view name) {
  const Json* value = find(in, name);
  return value != nullptr && value->is_string() ? value->get<std::string>() : "";
}
const Json* extension(const Json& in, absl::string_view name) {
  const Json* extensions = object(in, "extensions");
  return extensions == nullptr ? nullptr : object(*extensions, name);
}
void remove_extension(Json& in, absl::string_view name) {
  if (object(in, "extensions") != nullptr) {
    in["extensions"].erase(std::string(name));
    if (in["extensions"].empty()) {
      in.erase("extensions");
    }
  }
}

std::string name_in(const Json& in) { return text(in, "name"); }

std::optional<std::size_t> whole(const Json& value) {
  constexpr double kMax = 9007199254740992.0;  // 2^53
  if (!value.is_number()) {
    return std::nullopt;
  }
  const double number = value.get<double>();
  const bool fits = number >= 0 && number <= kMax && std::floor(number) == number;
  return fits ? std::optional(static_cast<std::size_t>(number)) : std::nullopt;
}

absl::StatusOr<std::size_t> whole_of(const Json& in, absl::string_view name,
                                     absl::string_view place,
                                     std::optional<std::size_t> otherwise) {
  const Json* value = find(in, name);
  if (value == nullptr && otherwise) {
    return *otherwise;
  }
  const auto number = value == nullptr ? std::nullopt : whole(*value);
  if (!number) {
    return damaged(absl::StrCat(place, ".", name),
                   value == nullptr ? "is missing" : "is not a whole number >= 0");
  }
  return *number;
}

const Json* item(const Json& root, absl::string_view name, double index) {
  const Json& all = items(root, name);
  const bool is_there = index >= 0 && index < static_cast<double>(all.size()) &&
                        all[static_cast<std::size_t>(index)].is_object();
  return is_there ? &all[static_cast<std::size_t>(index)] : nullptr;
}

const Json* item_of(const Json& root, absl::string_view name, const Json& in,
                    absl::string_view member) {
  return item(root, name, number(in, member).value_or(-1));
}

}  // namespace bandsaw::gltf
