#pragma once

// Suggests a correction of a mistyped word.

#include <optional>
#include <string>
#include <vector>

namespace bandsaw::coordinator {

/// Returns the known word with the smallest edit distance (insertion, deletion, substitution,
/// transposition of neighbours) from `word`, if that is at most a third of its length, but at least
/// 1 is allowed; the first one on ties.
std::optional<std::string> did_you_mean(const std::string& word,
                                        const std::vector<std::string>& known);

}  // namespace bandsaw::coordinator
