// A JsonObject turns each field into JSON text when it is added. Text is escaped as JSON requires;
// each byte that is not UTF-8 becomes U+FFFD.

#include "coordinator/cli/base/json.h"

#include <array>
#include <charconv>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"

namespace bandsaw::coordinator {
namespace {

// Returns the byte at `i`. Beyond the end it returns 0, which continues no UTF-8 sequence.
unsigned byte_at(absl::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

// Returns the number of bytes of the UTF-8 sequence that begins at `i`, or 0 if no valid sequence
// begins at `i`. The ranges of bytes are those of RFC 3629, section 4.
std::size_t sequence_at(absl::string_view text, std::size_t i) {
  const unsigned a = byte_at(text, i);
  const unsigned b = byte_at(text, i + 1);
  const auto tail = [&](std::size_t k) { return (byte_at(text, i + k) & 0xC0U) == 0x80U; };
  if (a < 0x80) {
    return 1;
  }
  if (a >= 0xC2 && a <= 0xDF) {
    return tail(1) ? 2 : 0;
  }
  if (a >= 0xE0 && a <= 0xEF) {
    const bool shortest = a != 0xE0 || b >= 0xA0;
    const bool no_surrogate = a != 0xED || b < 0xA0;
    return tail(1) && tail(2) && shortest && no_surrogate ? 3 : 0;
  }
  if (a >= 0xF0 && a <= 0xF4) {
    const bool in_range = (a != 0xF0 || b >= 0x90) && (a != 0xF4 || b < 0x90);
    return tail(1) && tail(2) && tail(3) && in_range ? 4 : 0;
  }
  return 0;
}

// Returns the text as a JSON string, in quotes.
std::string json_string(absl::string_view text) {
  std::string out = "\"";
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t bytes = sequence_at(text, i);
    const unsigned c = byte_at(text, i);
    if (bytes == 0) {
      out += "\xEF\xBF\xBD";
    } else if (c == '"' || c == '\\') {
      absl::StrAppend(&out, "\\", text.substr(i, 1));
    } else if (c < 0x20) {
      absl::StrAppendFormat(&out, "\\u%04x", c);
    } else {
      absl::StrAppend(&out, text.substr(i, bytes));
    }
    i += bytes == 0 ? 1 : bytes;
  }
  return out + "\"";
}

}  // namespace

JsonObject& JsonObject::raw(absl::string_view key, absl::string_view value) {
  fields_.push_back(absl::StrCat(json_string(key), ":", value));
  return *this;
}

JsonObject& JsonObject::text(absl::string_view key, absl::string_view value) {
  return raw(key, json_string(value));
}

JsonObject& JsonObject::number(absl::string_view key, double value) {
  if (!std::isfinite(value)) {
    return raw(key, "null");
  }
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return raw(key, absl::string_view(digits.data(), static_cast<std::size_t>(end - digits.data())));
}

JsonObject& JsonObject::whole(absl::string_view key, std::uint64_t value) {
  return raw(key, absl::StrCat(value));
}

JsonObject& JsonObject::flag(absl::string_view key, bool value) {
  return raw(key, value ? "true" : "false");
}

JsonObject& JsonObject::known_number(absl::string_view key, double value) {
  return value < 0 ? raw(key, "null") : number(key, value);
}

JsonObject& JsonObject::texts(absl::string_view key, const std::vector<std::string>& values) {
  std::string list;
  for (const std::string& value : values) {
    absl::StrAppend(&list, list.empty() ? "" : ",", json_string(value));
  }
  return raw(key, "[" + list + "]");
}

JsonObject& JsonObject::objects(absl::string_view key, const std::vector<JsonObject>& values) {
  std::string list;
  for (const JsonObject& value : values) {
    absl::StrAppend(&list, list.empty() ? "" : ",", value.str());
  }
  return raw(key, "[" + list + "]");
}

JsonObject& JsonObject::object(absl::string_view key, const JsonObject& value) {
  return raw(key, value.str());
}

JsonObject& JsonObject::unknown(absl::string_view key) { return raw(key, "null"); }

std::string JsonObject::str() const { return absl::StrCat("{", absl::StrJoin(fields_, ","), "}"); }

std::string JsonObject::lines() const {
  return absl::StrCat("{\n  ", absl::StrJoin(fields_, ",\n  "), "\n}\n");
}

}  // namespace bandsaw::coordinator
