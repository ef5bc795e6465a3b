// Parsers for numbers with units. Each accepts only plain decimal notation and the units that its
// error message names.

#include "coordinator/cli/options/quantities.h"

#include <cmath>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {
namespace {

absl::Status must_be(const std::string& name, absl::string_view allowed, const std::string& found) {
  return absl::InvalidArgumentError(
      absl::StrCat(name, ": must be ", allowed, ", is '", found, "'"));
}

// Accepts plain decimal notation only, neither "inf", "nan" nor "0x10". Returns false if the text
// is anything else.
bool parse_decimal(absl::string_view text, double& value) {
  return !text.empty() && text.find_first_not_of("0123456789.") == absl::string_view::npos &&
         absl::SimpleAtod(text, &value) && std::isfinite(value);
}

}  // namespace

absl::StatusOr<std::uint64_t> parse_whole(const std::string& name, const std::string& text,
                                          std::uint64_t least, std::uint64_t most) {
  std::uint64_t value = 0;
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || !absl::SimpleAtoi(text, &value) || value < least || value > most) {
    return must_be(name, absl::StrCat("a whole number in [", least, ", ", most, "]"), text);
  }
  return value;
}

absl::StatusOr<double> parse_percent(const std::string& name, const std::string& text) {
  absl::string_view number = text;
  double percent = 0;
  const bool sign = absl::ConsumeSuffix(&number, "%");
  number = absl::StripTrailingAsciiWhitespace(number);
  if (!sign || !parse_decimal(number, percent) || percent <= 0 || percent > 100) {
    return must_be(name, "a percentage in (0 %, 100 %], as in 1%", text);
  }
  return percent / 100;
}

absl::StatusOr<double> parse_seconds(const std::string& name, const std::string& text) {
  constexpr double kMin = 0.1;
  constexpr double kMax = 30.0 * 24 * 3600;  // 30 days, the 720h of the message
  absl::string_view number = text;
  double unit = 1;
  if (absl::ConsumeSuffix(&number, "h")) {
    unit = 3600;
  } else if (absl::ConsumeSuffix(&number, "m")) {
    unit = 60;
  } else {
    absl::ConsumeSuffix(&number, "s");
  }
  double count = 0;
  if (!parse_decimal(number, count) || count * unit < kMin || count * unit > kMax) {
    return must_be(name, "a time from 0.1s to 720h, as in 5s, 2m, 1.5h", text);
  }
  return count * unit;
}

absl::StatusOr<RowRange> parse_rows(const std::string& name, const std::string& text) {
  const std::pair<std::string, std::string> ends = absl::StrSplit(text, absl::MaxSplits(':', 1));
  const auto first = parse_whole(name, ends.first, 0, kMaxSide);
  const auto last = parse_whole(name, ends.second, 0, kMaxSide);
  if (!first.ok() || !last.ok() || *first >= *last) {
    return must_be(
        name,
        absl::StrCat("y0:y1 with 0 <= y0 < y1 <= ", kMaxSide, " (rows from the top, y1 excluded)"),
        text);
  }
  return RowRange{static_cast<std::uint32_t>(*first), static_cast<std::uint32_t>(*last)};
}

}  // namespace bandsaw::coordinator
