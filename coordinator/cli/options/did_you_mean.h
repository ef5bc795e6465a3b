#pragma once

// The word that was probably meant.

#include <optional>
#include <string>
#include <vector>

namespace bandsaw::coordinator {

/// The known word with the fewest single-letter edits (insert, remove, replace, swap of neighbours)
/// from `word`, if that is at most a third of its length; the first such on ties.
std::optional<std::string> did_you_mean(const std::string& word,
                                        const std::vector<std::string>& known);

}  // namespace bandsaw::coordinator
