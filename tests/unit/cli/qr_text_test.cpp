// A QR code in the characters of a terminal.

#include "coordinator/cli/machines/qr_text.h"

#include <gtest/gtest.h>

#include "absl/strings/str_split.h"

namespace bandsaw::coordinator {
namespace {

TEST(QrText, EveryModuleIsHalfABlockInBlackOnWhite) {
  // A square of two modules, dark on its diagonal.
  const std::string text = qr_text({.side = 2, .dark = {true, false, false, true}});
  const std::vector<std::string> lines = absl::StrSplit(text, '\n');
  ASSERT_EQ(lines.size(), 6U) << "ten rows with the margin, two a line, and the last line end";
  const std::string begin = "\x1b[38;5;16;48;5;231m";
  const std::string end = "\x1b[0m";
  EXPECT_EQ(lines[0], begin + "          " + end);
  EXPECT_EQ(lines[2], begin + "    ▀▄    " + end);
  EXPECT_EQ(lines[4], begin + "          " + end);
}

}  // namespace
}  // namespace bandsaw::coordinator
