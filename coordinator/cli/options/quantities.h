#pragma once

// Strict parsers for numbers with units that the user types. The whole text must match and be in
// range; otherwise the error is INVALID_ARGUMENT and states the allowed values and the typed text.
// `name` is the option's name, for the error.

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// Parses a whole number in [least, most].
absl::StatusOr<std::uint64_t> parse_whole(const std::string& name, const std::string& text,
                                          std::uint64_t least, std::uint64_t most);

/// Parses a whole number in [least, most] into `value`, which is unchanged if `text` is
/// std::nullopt.
template <class T>
absl::Status read_whole(const std::string& name, const std::optional<std::string>& text,
                        std::uint64_t least, std::uint64_t most, T& value) {
  if (text) {
    const absl::StatusOr<std::uint64_t> whole = parse_whole(name, *text, least, most);
    if (!whole.ok()) {
      return whole.status();
    }
    value = static_cast<T>(*whole);
  }
  return absl::OkStatus();
}
/// The overload for a `value` that may be unset. It stays unset if `text` is std::nullopt.
template <class T>
absl::Status read_whole(const std::string& name, const std::optional<std::string>& text,
                        std::uint64_t least, std::uint64_t most, std::optional<T>& value) {
  return text ? read_whole(name, text, least, most, value.emplace()) : absl::OkStatus();
}

/// Parses a percentage in (0, 100], such as "1%" or "0.5 %", and returns it as a fraction. The
/// percent sign is required, because "0.01" alone could mean 1 % or 0.01 %.
absl::StatusOr<double> parse_percent(const std::string& name, const std::string& text);

/// Parses a time in [0.1 s, 30 days]: "5s", "2m", "1h", "1.5h", "90" (seconds). Returns seconds.
absl::StatusOr<double> parse_seconds(const std::string& name, const std::string& text);

/// Parses "y0:y1", the rows from y0 to y1 - 1, counted from the top; 0 <= y0 < y1 <= kMaxSide.
absl::StatusOr<RowRange> parse_rows(const std::string& name, const std::string& text);

}  // namespace bandsaw::coordinator
