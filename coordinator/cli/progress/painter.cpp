// frame() returns the text that moves the cursor back over the lines that were drawn before, and
// draws the new ones over them.

#include "coordinator/cli/progress/painter.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/text.h"

namespace bandsaw::coordinator {

std::string Painter::frame(const std::vector<std::string>& lines, TerminalSize size,
                           const std::vector<std::string>& picture) {
  std::string out = back_to_first();
  const std::size_t available = std::max<std::size_t>(size.rows, 2) - 1;
  drawn_ = std::min(picture.size() + lines.size(), available);
  for (std::size_t i = 0; i < drawn_; ++i) {
    // One column is left free, because a full line wraps on some terminals.
    const std::string line = i < picture.size() ? picture[i]
                                                : fit(lines[i - picture.size()],
                                                      std::max<std::size_t>(size.columns, 2) - 1);
    absl::StrAppend(&out, line, "\x1b[K\n");
  }
  return out + "\x1b[J";
}

// When Ctrl-C is pressed, a terminal shows ^C at the cursor and so moves the cursor to the right.
// The carriage return moves the cursor back to the first column.
std::string Painter::back_to_first() const {
  return drawn_ > 0 ? absl::StrCat("\r\x1b[", drawn_, "A") : "";
}

std::string Painter::clear() {
  if (drawn_ == 0) {
    return "";
  }
  const std::string out = back_to_first() + "\x1b[J";
  drawn_ = 0;
  return out;
}

}  // namespace bandsaw::coordinator
