// Formats numbers, times and lists for users. A number just below a power of ten is rounded up to
// the power: 9.95 with one decimal would be "10.0". Therefore the code compares numbers with 0.995,
// 9.95, 99.95 and 999.5 instead of 1, 10, 100 and 1000.

#include "coordinator/cli/base/text.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "renderlib/base/overloaded.h"

namespace bandsaw::coordinator {
namespace {

// Formats with one decimal below ten, without decimals from ten on; "1.0" becomes "1".
std::string short_number(double value) {
  const std::string text =
      value < 9.95 ? absl::StrFormat("%.1f", value) : absl::StrFormat("%.0f", value);
  return std::string(absl::StripSuffix(text, ".0"));
}

// Returns true for the second and later bytes of a UTF-8 sequence.
bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

}  // namespace

std::string si(double value) {
  constexpr std::array<const char*, 7> kLetters = {"", " k", " M", " G", " T", " P", " E"};
  std::size_t letter = 0;
  while (value >= 999.5 && letter + 1 < kLetters.size()) {
    value /= 1000;
    ++letter;
  }
  return absl::StrCat(short_number(value), kLetters[letter]);
}

std::string si_with(double value, absl::string_view unit) {
  const std::string text = si(value);
  return absl::StrCat(text, text.find(' ') == std::string::npos ? " " : "", unit);
}

// clock_time() and duration() limit the time to 1e9 s (32 years), so that it fits into an integer.
std::string clock_time(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::ceil(std::clamp(seconds, 0.0, 1e9)));
  const std::uint64_t hours = whole / 3600;
  const std::uint64_t minutes = whole / 60 % 60;
  return hours > 0 ? absl::StrFormat("%d:%02d:%02d", hours, minutes, whole % 60)
                   : absl::StrFormat("%d:%02d", minutes, whole % 60);
}

std::string duration(double seconds) {
  const auto whole = static_cast<std::uint64_t>(std::lround(std::clamp(seconds, 0.0, 1e9)));
  if (whole >= 3600) {
    return absl::StrFormat("%d h %d min", whole / 3600, whole / 60 % 60);
  }
  if (seconds >= 99.95) {
    return absl::StrFormat("%d min %d s", whole / 60, whole % 60);
  }
  return seconds < 0.995 ? absl::StrFormat("%.2f s", seconds) : absl::StrFormat("%.1f s", seconds);
}

std::string percent(double fraction) {
  const double value = fraction * 100;
  if (value < 0.0095) {
    return absl::StrFormat("%.2g %%", value);
  }
  const int digits = value < 0.995 ? 2 : value < 9.95 ? 1 : 0;
  std::string text = absl::StrFormat("%.*f", digits, value);
  if (digits > 0) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') {
      text.pop_back();
    }
  }
  return text + " %";
}

std::string stop_text(const StopRule& stop) {
  return std::visit(Overloaded{
                        [](const StopAtSamples& s) {
                          return absl::StrCat(s.samples, s.samples == 1 ? " sample" : " samples");
                        },
                        [](const StopAtError& s) { return "error ≤ " + percent(s.relative_rmse); },
                        [](const StopAtTime& s) { return duration(s.seconds); },
                    },
                    stop);
}

std::string printable(absl::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    // In UTF-8, the control characters U+0080 to U+009F are the byte C2 and one more byte.
    const bool c1 =
        c == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (c == '\n' || c == '\r' || c == '\t') {
      out += ' ';
    } else if (c < 0x20 || c == 0x7F || c1) {
      out += '?';
      i += c1 ? 1 : 0;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string printable_list(const std::vector<std::string>& names) {
  return printable(absl::StrJoin(names, ", "));
}

std::string shell_word(absl::string_view text) {
  const bool plain =
      !text.empty() && text.front() != '#' && std::all_of(text.begin(), text.end(), [](char c) {
        return absl::ascii_isalnum(static_cast<unsigned char>(c)) ||
               absl::string_view("%+,-./:=@_#").find(c) != absl::string_view::npos;
      });
  return plain ? std::string(text)
               : absl::StrCat("'", absl::StrReplaceAll(text, {{"'", R"('\'')"}}), "'");
}

std::size_t columns(absl::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !continues(c); }));
}

std::string fit(absl::string_view text, std::size_t width) {
  if (columns(text) <= width) {
    return std::string(text);
  }
  if (width == 0) {
    return "";
  }
  std::size_t end = 0;
  for (std::size_t column = 0; column + 1 < width; ++column) {
    do {
      ++end;
    } while (end < text.size() && continues(text[end]));
  }
  return absl::StrCat(text.substr(0, end), "…");
}

std::string pad_right(absl::string_view text, std::size_t width) {
  return absl::StrCat(text, std::string(width - std::min(width, columns(text)), ' '));
}

std::string pad_left(absl::string_view text, std::size_t width) {
  return absl::StrCat(std::string(width - std::min(width, columns(text)), ' '), text);
}

}  // namespace bandsaw::coordinator
