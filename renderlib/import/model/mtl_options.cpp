// Reads an MTL file line by line. A line "newmtl NAME" begins a material. In the line of a texture,
// options and their arguments stand between the keyword and the name of the image.

#include "renderlib/import/model/mtl_options.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_split.h"

namespace bandsaw {
namespace {

// Removes the next word and the white space around it from the line, and returns the word; "" at
// the end of the line.
absl::string_view take_word(absl::string_view& line) {
  line = absl::StripAsciiWhitespace(line);
  const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
  const absl::string_view word = line.substr(0, end);
  line = absl::StripAsciiWhitespace(line.substr(end));
  return word;
}

// Removes the numbers with which the line begins, at most three, and returns them.
std::vector<double> take_numbers(absl::string_view& line) {
  std::vector<double> numbers;
  while (numbers.size() < 3) {
    absl::string_view rest = line;
    double number = 0;
    if (!absl::SimpleAtod(take_word(rest), &number) || !std::isfinite(number)) {
      break;
    }
    numbers.push_back(number);
    line = rest;
  }
  return numbers;
}

// Returns true if a line with this keyword, in lower case, names a texture.
bool is_texture(const std::string& keyword) {
  return absl::StartsWith(keyword, "map_") || keyword == "bump" || keyword == "norm";
}

// Adds the options of one texture of `material`. `line` is what follows the keyword.
void read_texture(const std::string& material, absl::string_view line, MtlOptions& to) {
  UvTransform transform;
  while (absl::StartsWith(line, "-")) {
    const absl::string_view option = take_word(line);
    const std::vector<double> numbers = take_numbers(line);
    if (numbers.empty()) {
      take_word(line);  // the argument is a word, such as "on" or "sphere"
    }
    if (option == "-s" || option == "-o") {
      // The matrix has 2 rows of 3: the scale is at 0 and 4, the offset at 2 and 5.
      for (std::size_t i = 0; i < std::min<std::size_t>(numbers.size(), 2); ++i) {
        transform.m[option == "-s" ? 4 * i : 2 + 3 * i] = numbers[i];
      }
    } else if (option == "-mm" || option == "-t" || option == "-imfchan") {
      to.ignored.emplace(option);
    }
  }
  if (!(transform == UvTransform{})) {
    to.transforms[{material, std::string(line)}] = transform;
  }
}

}  // namespace

void add_mtl_options(absl::string_view text, MtlOptions& to) {
  std::string material;
  for (absl::string_view line : absl::StrSplit(text, absl::ByAnyChar("\r\n"), absl::SkipEmpty())) {
    const std::string keyword = absl::AsciiStrToLower(take_word(line));
    if (keyword == "newmtl") {
      material = std::string(line);
    } else if (is_texture(keyword)) {
      read_texture(material, line, to);
    }
  }
}

}  // namespace bandsaw
