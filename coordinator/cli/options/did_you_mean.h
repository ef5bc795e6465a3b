#pragma once

// Suggests a correction of a mistyped word.

#include <optional>
#include <string>
#include <vector>

namespace bandsaw::coordinator {

/// Returns the known word with the smallest edit distance (insertion, deletion, substitution,
/// transposition of neighbours) from `word`, if the distance is at most 1 or a third of the length
/// of `word`; the first one on ties.
std::optional<std::string> did_you_mean(const std::string& word,
                                        const std::vector<std::string>& known);

}  // namespace bandsaw::coordinator
