#pragma once

#include <string>
#include <vector>

namespace bandsaw {

/// Returns `; did you mean "radius"?`, the end of an error message, with the known name nearest to
/// `name`. Returns an empty string if none is near: the Levenshtein distance of a near one is 1, or
/// at most a third of the length of `name`.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

}  // namespace bandsaw
