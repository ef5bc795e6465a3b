#pragma once

// Cleans names from foreign files, so that they can be printed in messages and on a terminal.

#include <cstddef>
#include <string>
#include <string_view>

namespace bandsaw {

/// Returns `text` as valid UTF-8 without control characters, cut between characters to at most
/// `most_bytes`. Each control character becomes '?', and so does each byte that is not part of a
/// UTF-8 character.
std::string clean_text(std::string_view text, std::size_t most_bytes);

}  // namespace bandsaw
