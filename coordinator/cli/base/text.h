#pragma once

// Numbers and words as people read them. UTF-8; pure functions.

#include <cstdint>
#include <string>

#include "absl/strings/string_view.h"
#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// A whole number or two digits, and an SI letter: "0", "950", "1.2 k", "5.2 M", "48 M".
std::string si(double value);

/// "48 Msamples", "950 samples".
std::string si_with(double value, absl::string_view unit);

/// "1:05", "1:02:03": minutes and seconds, hours when there are any; rounded up, so that 0:00 means
/// over.
std::string clock_time(double seconds);

/// "0.42 s", "21.4 s", "3 min 20 s", "2 h 5 min".
std::string duration(double seconds);

/// "1.6 %", "0.99 %", "12 %": a fraction as a percentage with two significant digits.
std::string percent(double fraction);

/// "64 samples", "error ≤ 1 %", "2 min": what a job runs until.
std::string stop_text(const StopRule& stop);

/// What came from elsewhere, safe to show on a terminal: control characters become '?', line ends a
/// space.
std::string printable(absl::string_view text);

/// Columns on a terminal, one for each code point.
std::size_t columns(absl::string_view text);

/// The text cut to at most `width` columns; the last of them is '…' where something was cut.
std::string fit(absl::string_view text, std::size_t width);

/// The text followed by spaces (or after them) to `width` columns.
std::string pad_right(absl::string_view text, std::size_t width);
std::string pad_left(absl::string_view text, std::size_t width);

}  // namespace bandsaw::coordinator
