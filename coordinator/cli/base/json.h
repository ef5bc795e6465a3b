#pragma once

// JSON objects (RFC 8259): one per line for --json, and reports.

#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"

namespace bandsaw::coordinator {

/// Builds an object with fields in the order in which they are added. Numbers are written so that
/// reading them gives the same double; a number that is not finite becomes null. In text that is
/// not UTF-8, each invalid byte becomes U+FFFD.
class JsonObject {
 public:
  JsonObject& text(absl::string_view key, absl::string_view value);
  JsonObject& number(absl::string_view key, double value);
  JsonObject& whole(absl::string_view key, std::uint64_t value);
  JsonObject& flag(absl::string_view key, bool value);
  /// Writes null if the value is negative, which means "unknown".
  JsonObject& known_number(absl::string_view key, double value);
  JsonObject& texts(absl::string_view key, const std::vector<std::string>& values);
  JsonObject& objects(absl::string_view key, const std::vector<JsonObject>& values);
  JsonObject& object(absl::string_view key, const JsonObject& value);
  /// Writes null.
  JsonObject& unknown(absl::string_view key);

  /// Returns "{…}" on one line, without a line end.
  std::string str() const;
  /// Returns an indented form with one field per line, with a line end.
  std::string lines() const;

 private:
  JsonObject& raw(absl::string_view key, absl::string_view value);
  std::vector<std::string> fields_;
};

}  // namespace bandsaw::coordinator
