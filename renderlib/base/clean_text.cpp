// Copies the characters of well-formed UTF-8, except control characters. Each control character,
// and each byte that is not well-formed, is replaced by "?".

#include "renderlib/base/clean_text.h"

#include <cstdint>

namespace bandsaw {
namespace {

// Returns the length in bytes of the well-formed UTF-8 character at the front of `text`, or 0 if
// there is none (Unicode 15, table 3-7).
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto follows = [&](std::size_t i, unsigned low, unsigned high) {
    return i < text.size() && byte(i) >= low && byte(i) <= high;
  };
  const unsigned lead = byte(0);
  if (lead < 0x80) {
    return 1;
  }
  if (lead >= 0xC2 && lead <= 0xDF) {
    return follows(1, 0x80, 0xBF) ? 2 : 0;
  }
  if (lead >= 0xE0 && lead <= 0xEF) {
    const unsigned low = lead == 0xE0 ? 0xA0 : 0x80;
    const unsigned high = lead == 0xED ? 0x9F : 0xBF;
    return follows(1, low, high) && follows(2, 0x80, 0xBF) ? 3 : 0;
  }
  if (lead >= 0xF0 && lead <= 0xF4) {
    const unsigned low = lead == 0xF0 ? 0x90 : 0x80;
    const unsigned high = lead == 0xF4 ? 0x8F : 0xBF;
    return follows(1, low, high) && follows(2, 0x80, 0xBF) && follows(3, 0x80, 0xBF) ? 4 : 0;
  }
  return 0;
}

// Returns true for C0, DEL and C1, which a terminal executes instead of showing.
bool is_control(std::string_view character) {
  const auto lead = static_cast<unsigned char>(character[0]);
  return lead < 0x20 || lead == 0x7F ||
         (lead == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0);
}

}  // namespace

std::string clean_text(std::string_view text, std::size_t most_bytes) {
  std::string clean;
  while (!text.empty()) {
    const std::size_t size = character_bytes(text);
    const bool good = size != 0 && !is_control(text.substr(0, size));
    const std::string_view character = good ? text.substr(0, size) : std::string_view("?");
    if (clean.size() + character.size() > most_bytes) {
      break;
    }
    clean += character;
    text.remove_prefix(size == 0 ? 1 : size);
  }
  return clean;
}

}  // namespace bandsaw
