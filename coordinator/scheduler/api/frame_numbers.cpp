// Parses the frame numbers of a sequence ("1-30,47"): each item between commas is a number or a
// range. frames_text() does the reverse and joins numbers to ranges.

#include "coordinator/scheduler/api/frame_numbers.h"

#include <algorithm>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Removes a whole number with an optional minus sign from the front of `text`. std::nullopt: there
/// is none.
std::optional<FrameNumber> take_number(absl::string_view& text) {
  std::size_t end = !text.empty() && text.front() == '-' ? 1 : 0;
  while (end < text.size() && absl::ascii_isdigit(static_cast<unsigned char>(text[end]))) {
    ++end;
  }
  FrameNumber number = 0;
  if (!absl::SimpleAtoi(text.substr(0, end), &number)) {
    return std::nullopt;
  }
  text.remove_prefix(end);
  return number;
}

/// Removes the first character of `text` if it is one of `characters`. Returns false if it is not.
bool take_one_of(absl::string_view& text, absl::string_view characters) {
  if (text.empty() || characters.find(text.front()) == absl::string_view::npos) {
    return false;
  }
  text.remove_prefix(1);
  return true;
}

/// Appends the numbers of one item, at most kMaxFrames.
absl::Status add_item(absl::string_view item, std::vector<FrameNumber>& out) {
  absl::string_view rest = item;
  const auto wrong = [&](const std::string& what) {
    return absl::InvalidArgumentError(absl::StrCat("'", item, "' ", what));
  };
  const std::optional<FrameNumber> first = take_number(rest);
  std::optional<FrameNumber> last = first;
  std::optional<FrameNumber> step = 1;
  if (first && take_one_of(rest, ":-")) {
    last = take_number(rest);
    if (last && take_one_of(rest, ":x")) {
      step = take_number(rest);
    }
  }
  if (!first || !last || !step || !rest.empty()) {
    return wrong("is neither a frame nor a range, as in 47, 1-30 or 1:240:2");
  }
  // Compares with both bounds, because the absolute value of the least FrameNumber does not fit
  // into a FrameNumber.
  const auto is_beyond = [](FrameNumber number) {
    return number > kMaxFrameNumber || number < -kMaxFrameNumber;
  };
  if (is_beyond(*first) || is_beyond(*last) || is_beyond(*step)) {
    return wrong(absl::StrCat("has a number beyond ", kMaxFrameNumber));
  }
  if (*last < *first) {
    return wrong("runs backwards");
  }
  if (*step < 1) {
    return wrong("has a step below 1");
  }
  if ((*last - *first) / *step >= static_cast<FrameNumber>(kMaxFrames)) {
    return wrong(absl::StrCat("has more than ", kMaxFrames, " frames"));
  }
  for (FrameNumber number = *first; number <= *last; number += *step) {
    out.push_back(number);
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::vector<FrameNumber>> parse_frames(absl::string_view text) {
  std::vector<FrameNumber> numbers;
  for (const absl::string_view item : absl::StrSplit(text, ',')) {
    RETURN_IF_ERROR(add_item(absl::StripAsciiWhitespace(item), numbers));
    // Bounds the memory and the time. The bound is above kMaxFrames, because items may overlap.
    if (numbers.size() > 2 * kMaxFrames) {
      return absl::InvalidArgumentError(
          absl::StrCat("'", text.substr(0, 40), "' lists more than ", 2 * kMaxFrames,
                       " frames, repeated ones included; list each once, or submit them in parts"));
    }
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  if (numbers.size() > kMaxFrames) {
    return absl::InvalidArgumentError(absl::StrCat("'", text.substr(0, 40), "' has more than ",
                                                   kMaxFrames, " frames; submit them in parts"));
  }
  return numbers;
}

std::string frames_text(const std::vector<FrameNumber>& numbers) {
  std::vector<std::string> items;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i + 1;
    const FrameNumber step = end < numbers.size() ? numbers[end] - numbers[i] : 0;
    while (end < numbers.size() && numbers[end] - numbers[end - 1] == step) {
      ++end;
    }
    // If the last number of this range also begins a range without a step, it is left to that
    // range: "1,3,5-40", not "1-5x2,6-40".
    if (step > 1 && end < numbers.size() && numbers[end] - numbers[end - 1] == 1) {
      --end;
    }
    // A range has at least three numbers, or two that follow each other directly.
    if (end - i < 3 && !(step == 1 && end - i == 2)) {
      items.push_back(absl::StrCat(numbers[i++]));
      continue;
    }
    items.push_back(absl::StrCat(numbers[i], numbers[i] < 0 ? ":" : "-", numbers[end - 1],
                                 step == 1 ? "" : absl::StrCat("x", step)));
    i = end;
  }
  return absl::StrJoin(items, ",");
}

}  // namespace bandsaw::coordinator
