// Walkthroughs are sections of READMEs which lead through the source files. Their headings begin
// with "Walkthrough:" or "Adding ". Checks that every file named in a walkthrough exists.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Walkthrough {
  fs::path readme;
  std::string heading;
  std::string text;
};

/// Appends the sections of a README whose heading begins with "Walkthrough:" or "Adding ". A
/// section ends at the next heading of its level or of a higher one.
void add_walkthroughs(const fs::path& readme, std::vector<Walkthrough>& to) {
  static const std::regex kHeading("(#+) (.*)");
  std::ifstream in(readme);
  std::size_t level = 0;  // heading level of the walkthrough that is being read; 0: none
  bool fenced = false;    // inside a block between two lines of ```, where # begins no heading
  for (std::string line; std::getline(in, line);) {
    fenced = fenced != line.starts_with("```");
    std::smatch heading;
    if (!fenced && std::regex_match(line, heading, kHeading)) {
      const auto depth = static_cast<std::size_t>(heading[1].length());
      const std::string title = heading[2];
      if (title.starts_with("Walkthrough:") || title.starts_with("Adding ")) {
        level = depth;
        to.push_back({readme, title, ""});
      } else if (depth <= level) {
        level = 0;
      }
    }
    if (level > 0) {
      to.back().text += line + "\n";
    }
  }
}

std::vector<Walkthrough> walkthroughs() {
  std::vector<Walkthrough> found;
  for (const char* top : {"proto", "renderlib", "coordinator", "worker", "deploy", "tests"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(BANDSAW_SOURCE) / top)) {
      if (entry.path().filename() == "README.md") {
        add_walkthroughs(entry.path(), found);
      }
    }
  }
  add_walkthroughs(fs::path(BANDSAW_SOURCE) / "README.md", found);
  return found;
}

/// Returns the file names and paths in a text. A word in backquotes counts if it has a slash or
/// one of the suffixes in kSource. A word with one of the suffixes in kInDiagram counts everywhere,
/// because the words of a diagram have no backquotes.
std::vector<std::string> paths_in(const std::string& text) {
  static const std::regex kQuoted("`([A-Za-z0-9_./-]+)`");
  static const std::regex kSource(R"(.*\.(h|cpp|proto|md|sh|txt))");
  static const std::regex kInDiagram(R"([A-Za-z0-9_./-]+\.(h|cpp|proto)\b)");
  std::vector<std::string> paths;
  for (std::sregex_iterator it(text.begin(), text.end(), kQuoted), end; it != end; ++it) {
    const std::string name = (*it)[1];
    if (name.find('/') != std::string::npos || std::regex_match(name, kSource)) {
      paths.push_back(name);
    }
  }
  for (std::sregex_iterator it(text.begin(), text.end(), kInDiagram), end; it != end; ++it) {
    paths.push_back(it->str());
  }
  return paths;
}

/// Returns true if `path` exists relative to the folder of the README or to the repository. `all`:
/// all paths of the walkthrough. A bare file name, as in a diagram, also exists if `all` contains
/// the path of an existing file with this name.
bool exists(const Walkthrough& walkthrough, const std::string& path,
            const std::vector<std::string>& all) {
  for (const fs::path& base : {walkthrough.readme.parent_path(), fs::path(BANDSAW_SOURCE)}) {
    if (fs::exists(base / path)) {
      return true;
    }
  }
  if (path.find('/') != std::string::npos) {
    return false;
  }
  for (const std::string& other : all) {
    if (other != path && fs::path(other).filename() == path && exists(walkthrough, other, {})) {
      return true;
    }
  }
  return false;
}

TEST(Walkthroughs, NameFilesThatExist) {
  const std::vector<Walkthrough> all = walkthroughs();
  EXPECT_GE(all.size(), 4u);  // fewer: the search has missed some
  for (const Walkthrough& walkthrough : all) {
    const std::vector<std::string> paths = paths_in(walkthrough.text);
    EXPECT_GE(paths.size(), 5u) << walkthrough.heading;  // fewer: paths_in() has missed some
    for (const std::string& path : paths) {
      EXPECT_TRUE(exists(walkthrough, path, paths))
          << walkthrough.readme << ", " << walkthrough.heading << ": there is no " << path;
    }
  }
}

}  // namespace
