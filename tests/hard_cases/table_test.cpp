// Checks that the table of README.md and the list cases.txt have every hard case once. Each row of
// the table must name the files of the tests of its case, or say in bold why there is no test. The
// name of a test begins with the ids of its cases.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace bandsaw::test {
namespace {

const std::string kTests = std::string(BANDSAW_SOURCE) + "/tests";

std::string read(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& path) {
  std::istringstream text(read(path));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// Returns the ids of all cases, such as "S1", in order. `sections` has the letter and the number
/// of cases of each section of cases.txt.
std::vector<std::string> known_ids() {
  const std::pair<const char*, int> sections[] = {
      {"S", 12}, {"T", 15}, {"Q", 8},  {"B", 12}, {"O", 8}, {"C", 10}, {"X", 9}, {"M", 15},
      {"L", 12}, {"V", 11}, {"TX", 8}, {"R", 10}, {"A", 8}, {"P", 6},  {"Y", 5}};
  std::vector<std::string> ids;
  for (const auto& [letter, count] : sections) {
    for (int i = 1; i <= count; ++i) {
      ids.push_back(letter + std::to_string(i));
    }
  }
  return ids;
}

/// Returns for each id of a case the files with tests of the case. The name of such a test begins
/// with the id, or with several ids: TEST(Media, V6V7_…).
std::map<std::string, std::set<std::string>> files_by_id() {
  std::map<std::string, std::set<std::string>> files;
  const std::regex test(R"(\bTEST(?:_F|_P)?\(\w+,\s*((?:[A-Z]{1,2}[0-9]+)+)(?=[_A-Z]))");
  const std::regex one("[A-Z]{1,2}[0-9]+");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kTests)) {
    if (entry.path().extension() != ".cpp") {
      continue;
    }
    const std::string text = read(entry.path());
    for (std::sregex_iterator t(text.begin(), text.end(), test), end; t != end; ++t) {
      const std::string ids = (*t)[1];
      for (std::sregex_iterator id(ids.begin(), ids.end(), one); id != end; ++id) {
        files[id->str()].insert(std::filesystem::relative(entry.path(), kTests));
      }
    }
  }
  return files;
}

TEST(HardCaseTable, ListsEveryCaseOnceInOrder) {
  std::vector<std::string> listed;
  for (const std::string& line : lines_of(kTests + "/hard_cases/cases.txt")) {
    listed.push_back(line.substr(0, line.find(" | ")));
  }
  EXPECT_EQ(listed, known_ids());
  std::vector<std::string> rows;
  const std::regex row(R"(^\| ([A-Z]{1,2}[0-9]+) \|.*)");
  std::smatch match;
  for (const std::string& line : lines_of(kTests + "/hard_cases/README.md")) {
    if (std::regex_match(line, match, row)) {
      rows.push_back(match[1]);
    }
  }
  EXPECT_EQ(rows, known_ids()) << "run tests/hard_cases/run.sh";
}

TEST(HardCaseTable, NamesTheTestOfEveryCaseOrTheReasonForNone) {
  const auto files = files_by_id();
  const std::vector<std::string> ids = known_ids();
  for (const auto& [id, where] : files) {
    EXPECT_NE(std::find(ids.begin(), ids.end(), id), ids.end()) << id << " in " << *where.begin();
  }
  for (const std::string& line : lines_of(kTests + "/hard_cases/README.md")) {
    // A row of the table begins with "| S1 |". The id begins after two characters and ends before
    // the next space.
    const std::string id =
        line.substr(0, line.find(' ', 2)).substr(std::min<std::size_t>(2, line.size()));
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) {
      continue;
    }
    if (files.count(id) == 0) {
      EXPECT_NE(line.find("**"), std::string::npos) << id << " has no test and no reason";
      continue;
    }
    bool named = false;
    for (const std::string& file : files.at(id)) {
      named = named || line.find('`' + file + '`') != std::string::npos;
    }
    EXPECT_TRUE(named) << id << ": run tests/hard_cases/run.sh";
  }
}

}  // namespace
}  // namespace bandsaw::test
