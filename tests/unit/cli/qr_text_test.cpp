// A QR code in the characters of a terminal. A module is one square of the code.

#include "coordinator/cli/machines/qr_text.h"

#include <gtest/gtest.h>

#include "absl/strings/str_split.h"

namespace bandsaw::coordinator {
namespace {

TEST(QrText, EachCharacterShowsTwoModulesInBlackOnWhite) {
  // A square of two modules, dark on its diagonal.
  const std::string text = qr_text({.side = 2, .dark = {true, false, false, true}});
  const std::vector<std::string> lines = absl::StrSplit(text, '\n');
  // With the margin, the code has ten rows, two in each line. The last line ends with a line break.
  ASSERT_EQ(lines.size(), 6U);
  const std::string begin = "\x1b[38;5;16;48;5;231m";
  const std::string end = "\x1b[0m";
  EXPECT_EQ(lines[0], begin + "          " + end);
  EXPECT_EQ(lines[2], begin + "    ▀▄    " + end);
  EXPECT_EQ(lines[4], begin + "          " + end);
}

}  // namespace
}  // namespace bandsaw::coordinator
