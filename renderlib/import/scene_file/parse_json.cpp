// Parses a scene file in JSON by protobuf, and finds line and column of a syntax error.

#include <google/protobuf/util/json_util.h>

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/scene_file/parse_scene.h"

namespace bandsaw {
namespace {

// Returns ":LINE:COLUMN" of a JSON error; "" if the position is unknown. For broken JSON, protobuf
// reports the cause, up to 40 characters of the text (`excerpt`), and a line with a caret below the
// position. `caret` is the number of characters before the caret. If the excerpt occurs once in the
// file, its position determines line and column.
std::string place_of(absl::string_view text, absl::string_view excerpt, std::size_t caret) {
  const std::size_t found = text.find(excerpt);
  if (excerpt.empty() || found == text.npos || text.find(excerpt, found + 1) != text.npos) {
    return "";
  }
  const std::size_t offset = std::min(text.size(), found + caret);
  const absl::string_view before = text.substr(0, offset);
  const auto line = std::count(before.begin(), before.end(), '\n') + 1;
  const std::size_t line_start = before.rfind('\n');
  const std::size_t column = line_start == before.npos ? offset : offset - line_start - 1;
  return absl::StrCat(":", line, ":", column + 1);
}

// Returns the error for broken JSON: file, position if place_of() finds it, and cause. `message` is
// protobuf's error. Its first line is the cause, and its last line has spaces and a caret.
absl::Status syntax_error(const std::string& text, const std::string& file,
                          absl::string_view message) {
  const std::size_t first = message.find('\n');
  const std::size_t last = message.rfind('\n');
  if (first == message.npos || last == first) {
    return absl::InvalidArgumentError(absl::StrCat(file, ": ", message));
  }
  const absl::string_view excerpt = message.substr(first + 1, last - first - 1);
  const std::size_t caret = message.size() - last - 2;
  return absl::InvalidArgumentError(
      absl::StrCat(file, place_of(text, excerpt, caret), ": ", message.substr(0, first)));
}

}  // namespace

absl::StatusOr<ParsedScene> parse_json(const std::string& text, const std::string& file) {
  ParsedScene parsed;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &parsed.scene);
  if (!status.ok()) {
    return syntax_error(text, file,
                        absl::string_view(status.message().data(), status.message().size()));
  }
  return parsed;
}

}  // namespace bandsaw
