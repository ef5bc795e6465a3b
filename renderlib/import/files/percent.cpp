// Decodes percent-encoded file names. Each "%" and the two hexadecimal digits after it become one
// byte, whose value the digits give.

#include "renderlib/import/files/percent.h"

#include <charconv>

namespace bandsaw {

std::string percent_decoded(absl::string_view text) {
  std::string decoded;
  while (!text.empty()) {
    unsigned char byte = 0;
    const bool escape = text.size() >= 3 && text[0] == '%' &&
                        std::from_chars(&text[1], &text[1] + 2, byte, 16).ptr == &text[1] + 2;
    decoded += escape ? static_cast<char>(byte) : text[0];
    text.remove_prefix(escape ? 3 : 1);
  }
  return decoded;
}

}  // namespace bandsaw
