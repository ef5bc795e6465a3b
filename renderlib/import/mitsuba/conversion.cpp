// Collects the warnings of the conversion of a Mitsuba scene. A repeated warning is stored once.
// Parameters that nothing has read cause warnings.

#include "renderlib/import/mitsuba/conversion.h"

#include <algorithm>

#include "absl/strings/str_cat.h"

namespace bandsaw::mitsuba {

void Conversion::warn(const Place& place, const std::string& what) {
  std::string text = absl::StrCat(text_of(place), ": ", what);
  if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) {
    warnings.push_back(std::move(text));
  }
}

void Conversion::warn_of_unused(const Parameters& parameters) {
  const Object& object = parameters.object();
  for (const Property* property : parameters.unused()) {
    const auto* const* child = std::get_if<const Object*>(&property->value);
    const std::string what =
        child != nullptr && property->name.empty()
            ? absl::StrCat("<", (*child)->tag, "> of type \"", (*child)->type, "\"")
            : absl::StrCat("parameter \"", property->name, "\"");
    warn(property->place, absl::StrCat(what, " of ", object.tag, " \"", object.type,
                                       "\" has no counterpart and is left out"));
  }
}

}  // namespace bandsaw::mitsuba
