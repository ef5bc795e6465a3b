#pragma once

#include <string>
#include <vector>

namespace bandsaw {

/// `; did you mean "radius"?` for the known name nearest to `name`, or nothing when none is near
/// (Levenshtein distance above a third of the length, at least 1).
std::string did_you_mean(const std::string& name, const std::vector<std::string>& known);

}  // namespace bandsaw
