#pragma once

// Parses the JSON of a glTF file and looks up its members. If a member has another type than the
// lookup function requests, the function treats it as missing.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw::gltf {

using Json = nlohmann::json;

/// Parses strict JSON whose root is an object. Returns INVALID_ARGUMENT if `text` is not JSON (the
/// message has the byte offset), not UTF-8, nested deeper than 100 levels, or larger than 256 MiB.
absl::StatusOr<Json> parse_json(absl::string_view text);

/// Returns INVALID_ARGUMENT: "PLACE: WHAT; the file is damaged: export it again".
absl::Status damaged(absl::string_view place, absl::string_view what);

/// Returns the member `name` of the object `in`; nullptr if there is none or `in` is no object.
const Json* find(const Json& in, absl::string_view name);
/// These functions do the same as find(), but object() also returns nullptr if the member is not an
/// object, and list() also returns nullptr if the member is not a list.
const Json* object(const Json& in, absl::string_view name);
const Json* list(const Json& in, absl::string_view name);
/// Returns the member `name` if it is a list; otherwise an empty list.
const Json& items(const Json& in, absl::string_view name);
/// Returns the member `name` if it is a number.
std::optional<double> number(const Json& in, absl::string_view name);
/// Returns the member `name` if it is a string; otherwise an empty string.
std::string text(const Json& in, absl::string_view name);
/// Returns the object `in.extensions.name`; nullptr if there is none.
const Json* extension(const Json& in, absl::string_view name);
/// Removes `in.extensions.name`, and `in.extensions` if it becomes empty.
void remove_extension(Json& in, absl::string_view name);
/// Returns the string member "name"; empty if there is none.
std::string name_in(const Json& in);

/// Returns a whole number in [0, 2^53], as used for counts, offsets and indices; std::nullopt if
/// `value` is not one.
std::optional<std::size_t> whole(const Json& value);
/// Returns the member `name` as a whole number in [0, 2^53]; `otherwise` if the member is missing.
/// Returns INVALID_ARGUMENT if the member is not a whole number, or if it is missing and there is
/// no `otherwise`. `place` names the object `in` in messages.
absl::StatusOr<std::size_t> whole_of(const Json& in, absl::string_view name,
                                     absl::string_view place,
                                     std::optional<std::size_t> otherwise = std::nullopt);

/// Returns the object with number `index` of the root's list `name`; nullptr if there is none.
const Json* item(const Json& root, absl::string_view name, double index);
/// Returns the object of the root's list `name` whose index is the value of the member `member` of
/// `in`; nullptr if there is none.
const Json* item_of(const Json& root, absl::string_view name, const Json& in,
                    absl::string_view member);

}  // namespace bandsaw::gltf
