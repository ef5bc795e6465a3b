#include "renderlib/import/files/percent.h"

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"

namespace bandsaw {

std::string percent_decoded(absl::string_view text) {
  std::string decoded;
  while (!text.empty()) {
    const bool escape = text.size() >= 3 && text[0] == '%' &&
                        absl::ascii_isxdigit(static_cast<unsigned char>(text[1])) &&
                        absl::ascii_isxdigit(static_cast<unsigned char>(text[2]));
    decoded += escape ? absl::HexStringToBytes(text.substr(1, 2)) : std::string(text.substr(0, 1));
    text.remove_prefix(escape ? 3 : 1);
  }
  return decoded;
}

}  // namespace bandsaw
