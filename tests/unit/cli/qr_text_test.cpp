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
  // With a margin of four modules on each side, the code has ten rows of modules. A line of text
  // shows two rows. The text ends with a line break, so the sixth element of `lines` is empty.
  ASSERT_EQ(lines.size(), 6U);
  const std::string begin = "\x1b[38;5;16;48;5;231m";  // sets black on white
  const std::string end = "\x1b[0m";                   // resets the colours
  EXPECT_EQ(lines[0], begin + "          " + end);
  EXPECT_EQ(lines[2], begin + "    ▀▄    " + end);
  EXPECT_EQ(lines[4], begin + "          " + end);
}

}  // namespace
}  // namespace bandsaw::coordinator
