#pragma once

// The JSON of a glTF file and functions that look things up in it. A member that is missing or has
// another type than the one asked for is nothing.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw::gltf {

using Json = nlohmann::json;

/// Parses strict JSON whose root is an object. INVALID_ARGUMENT: not JSON (with the byte where it
/// breaks), not UTF-8, nested deeper than 100 levels, or larger than 256 MiB.
absl::StatusOr<Json> parse_json(absl::string_view text);

/// INVALID_ARGUMENT: "PLACE: WHAT; the file is damaged: export it again".
absl::Status damaged(absl::string_view place, absl::string_view what);

/// The member `name` of the object `in`; null where there is none, or `in` is no object.
const Json* find(const Json& in, absl::string_view name);
const Json* object(const Json& in, absl::string_view name);
const Json* list(const Json& in, absl::string_view name);
/// The same; an empty list where there is none.
const Json& items(const Json& in, absl::string_view name);
std::optional<double> number(const Json& in, absl::string_view name);
/// A string; empty where there is none.
std::string text(const Json& in, absl::string_view name);
/// `in.extensions.name`.
const Json* extension(const Json& in, absl::string_view name);
/// Removes `in.extensions.name`, and `in.extensions` if nothing else is in it.
void remove_extension(Json& in, absl::string_view name);
/// The object's own name; may be empty.
std::string name_in(const Json& in);

/// A whole number in [0, 2^53], as which a count, an offset or an index is written.
std::optional<std::size_t> whole(const Json& value);
/// The member `name` as such a number. `otherwise` where there is no such member; without
/// `otherwise` it is required. INVALID_ARGUMENT: it is missing or no whole number; `place` names
/// the object `in`.
absl::StatusOr<std::size_t> whole_of(const Json& in, absl::string_view name,
                                     absl::string_view place,
                                     std::optional<std::size_t> otherwise = std::nullopt);

/// The object number `index` of the root's list `name`.
const Json* item(const Json& root, absl::string_view name, double index);
/// The same for the index that stands in `in.member`.
const Json* item_of(const Json& root, absl::string_view name, const Json& in,
                    absl::string_view member);

}  // namespace bandsaw::gltf
