// Who runs a suite knows how long it takes: every label that a test has stands in the table of
// tests/README.md, with its time.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace {

using ::testing::Contains;
using ::testing::Key;

std::string text_of(const std::string& file) {
  std::ifstream in(std::string(BANDSAW_SOURCE) + "/" + file);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// LABELS default, LABELS "default;tsan" … Comments say them too, of no test.
std::set<std::string> labels_of_tests() {
  static const std::regex kLabels(R"re(LABELS "?([a-z0-9_]+(;[a-z0-9_]+)*))re");
  static const std::regex kWord("[a-z0-9_]+");
  std::set<std::string> labels;
  for (const char* file : {"tests/CMakeLists.txt", "tests/fuzz/CMakeLists.txt"}) {
    static const std::regex kComment("#[^\n]*");
    const std::string text = std::regex_replace(text_of(file), kComment, "");
    for (std::sregex_iterator it(text.begin(), text.end(), kLabels), end; it != end; ++it) {
      const std::string list = (*it)[1];
      for (std::sregex_iterator word(list.begin(), list.end(), kWord); word != end; ++word) {
        labels.insert(word->str());
      }
    }
  }
  return labels;
}

/// The table | label | what runs | time |.
std::map<std::string, std::string> times_of_labels() {
  static const std::regex kRow(R"re(\| `([a-z0-9_]+)` \|[^|\n]*\| ([^|\n]*) \|)re");
  const std::string readme = text_of("tests/README.md");
  const std::size_t table = readme.find("| label | what runs | time |");
  EXPECT_NE(table, std::string::npos);
  const std::string text = readme.substr(table, readme.find("\n\n", table) - table);
  std::map<std::string, std::string> times;
  for (std::sregex_iterator it(text.begin(), text.end(), kRow), end; it != end; ++it) {
    times[(*it)[1]] = (*it)[2];
  }
  return times;
}

TEST(Labels, AllHaveTheirTimeInTheReadme) {
  const std::regex time("(second|minute|hour)s?");
  const std::set<std::string> labels = labels_of_tests();
  const std::map<std::string, std::string> times = times_of_labels();
  EXPECT_GE(labels.size(), 9u);
  for (const std::string& label : labels) {
    EXPECT_THAT(times, Contains(Key(label)));
  }
  for (const auto& [label, told] : times) {
    EXPECT_THAT(labels, Contains(label));
    EXPECT_TRUE(std::regex_search(told, time)) << label << ": " << told;
  }
}

}  // namespace
