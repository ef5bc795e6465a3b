#pragma once

// Suggests a correction for a mistyped command, option or value.

#include <optional>
#include <string>
#include <vector>

namespace bandsaw::coordinator {

/// Returns the word of `known` that has the smallest edit distance from `word`; if several words
/// have this distance, the first of them. An edit inserts, deletes or replaces a letter, or swaps
/// two neighbours. Returns std::nullopt if that distance is greater than both 1 and a third of the
/// length of `word`, or if `word` is longer than 64 bytes.
std::optional<std::string> did_you_mean(const std::string& word,
                                        const std::vector<std::string>& known);

}  // namespace bandsaw::coordinator
