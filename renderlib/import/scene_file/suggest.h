#pragma once

#include <string>
#include <vector>

namespace bandsaw {

/// Returns the end of an error message, such as `; did you mean "radius"?`, with the known name
/// that is nearest to `name`. A known name is near if its Levenshtein distance from `name`,
/// ignoring case, is at most 1 or at most a third of the length of `name`. Returns an empty string
/// if no known name is near, or if `name` is longer than 100 characters.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

}  // namespace bandsaw
