// The changelog names the pixel version that the newest entry is about.

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <string>

#include "renderlib/render/pixel_version.h"

namespace bandsaw {
namespace {

TEST(Changelog, NamesThePixelVersion) {
  std::ifstream file(std::string(BANDSAW_SOURCE) + "/.github/CHANGELOG.md");
  const std::regex version("Pixel version ([0-9]+)\\.");
  std::smatch found;
  std::string line;
  while (std::getline(file, line) && !std::regex_match(line, found, version)) {
  }
  ASSERT_FALSE(found.empty()) << "a line 'Pixel version N.'";
  EXPECT_EQ(found[1], std::to_string(kPixelVersion));
}

}  // namespace
}  // namespace bandsaw
