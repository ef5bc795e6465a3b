#pragma once

// The quantities people type, read strictly: the whole text, in range, or an error that says what
// is allowed and what was found. `name` is the option they were given to, for the error. All errors
// are INVALID_ARGUMENT.

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// A whole number in [least, most].
absl::StatusOr<std::uint64_t> parse_whole(const std::string& name, const std::string& text,
                                          std::uint64_t least, std::uint64_t most);

/// The same into `value`, which stays as it is where nothing was given.
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
template <class T>
absl::Status read_whole(const std::string& name, const std::optional<std::string>& text,
                        std::uint64_t least, std::uint64_t most, std::optional<T>& value) {
  return text ? read_whole(name, text, least, most, value.emplace()) : absl::OkStatus();
}

/// "1%", "0.5 %": a percentage in (0, 100], as a fraction. The sign is required: 0.01 alone could
/// mean either.
absl::StatusOr<double> parse_percent(const std::string& name, const std::string& text);

/// "5s", "2m", "1h", "1.5h", "90" (seconds): seconds in [0.1, 30 days].
absl::StatusOr<double> parse_seconds(const std::string& name, const std::string& text);

/// "y0:y1": rows [y0, y1), y0 < y1 <= 65536.
absl::StatusOr<RowRange> parse_rows(const std::string& name, const std::string& text);

}  // namespace bandsaw::coordinator
