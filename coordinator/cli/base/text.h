#pragma once

// Formats numbers and text for display. The functions are pure; text is UTF-8. Numbers, fractions
// and times must not be negative.

#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "coordinator/scheduler/api/job_spec.h"

namespace bandsaw::coordinator {

/// Formats a number with an SI prefix. A mantissa below 10 has one decimal, unless that decimal is
/// 0. Any other mantissa is a whole number: "0", "950", "1.2 k", "5.2 M", "48 M".
std::string si(double value);

/// Formats a number as si() does and adds the unit: "48 Msamples", "950 samples".
std::string si_with(double value, absl::string_view unit);

/// Formats a time as minutes and seconds, with hours if there are any: "1:05", "1:02:03". It is
/// rounded up to a second, so that a remaining time of 0:00 means finished.
std::string clock_time(double seconds);

/// Formats a time with its units: "0.42 s", "21.4 s", "3 min 20 s", "2 h 5 min".
std::string duration(double seconds);

/// Formats a fraction as a percentage with two significant digits: "1.6 %", "0.99 %", "12 %".
std::string percent(double fraction);

/// Describes the stop rule of a job: "64 samples", "error ≤ 1 %", "2 min".
std::string stop_text(const StopRule& stop);

/// Makes text from another program or user safe for a terminal: control characters become '?'; line
/// ends and tabs become spaces.
std::string printable(absl::string_view text);

/// Joins names with commas and makes them safe for a terminal: "cornell.png, cornell.pfm".
std::string printable_list(const std::vector<std::string>& names);

/// Returns the text as one word of a shell's command line. It is quoted if it contains characters
/// that may have a meaning to the shell.
std::string shell_word(absl::string_view text);

/// Returns the number of columns of a terminal that the text takes, one for each code point.
std::size_t columns(absl::string_view text);

/// Truncates the text to at most `width` columns; the last column is '…' if text was removed.
std::string fit(absl::string_view text, std::size_t width);

/// Adds spaces after the text up to `width` columns. A longer text is returned unchanged.
std::string pad_right(absl::string_view text, std::size_t width);
/// Adds spaces before the text up to `width` columns. A longer text is returned unchanged.
std::string pad_left(absl::string_view text, std::size_t width);

}  // namespace bandsaw::coordinator
