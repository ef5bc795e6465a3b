#pragma once

// Builds JSON objects (RFC 8259): the lines that commands print with --json, and the reports beside
// images.

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
  /// Adds an unsigned integer.
  JsonObject& whole(absl::string_view key, std::uint64_t value);
  JsonObject& flag(absl::string_view key, bool value);
  /// Adds a number that may be unknown: a negative value means "unknown" and becomes null.
  JsonObject& known_number(absl::string_view key, double value);
  JsonObject& texts(absl::string_view key, const std::vector<std::string>& values);
  JsonObject& objects(absl::string_view key, const std::vector<JsonObject>& values);
  JsonObject& object(absl::string_view key, const JsonObject& value);
  /// Adds null.
  JsonObject& unknown(absl::string_view key);

  /// Returns "{…}" on one line, without a line end.
  std::string str() const;
  /// Returns an indented form with one field per line, with a line end.
  std::string lines() const;

 private:
  /// Adds a value that is already JSON.
  JsonObject& raw(absl::string_view key, absl::string_view value);
  std::vector<std::string> fields_;  ///< each "key":value
};

}  // namespace bandsaw::coordinator
