#pragma once

#include <string>
#include <vector>

namespace bandsaw {

/// Returns `; did you mean "radius"?` with the known name nearest to `name`, or an empty string if
/// none is near (Levenshtein distance above a third of the length, at least 1).
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

}  // namespace bandsaw
