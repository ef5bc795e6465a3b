// Escapes quotation marks, backslashes and control characters.

#include "worker/browser/json_text.h"

namespace bandsaw::worker {

std::string json_text(absl::string_view text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string json = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      json += {'\\', c};
    } else if (byte < 0x20) {
      json += {'\\', 'u', '0', '0', kDigits[byte >> 4], kDigits[byte & 15]};
    } else {
      json += c;
    }
  }
  return json + "\"";
}

}  // namespace bandsaw::worker
