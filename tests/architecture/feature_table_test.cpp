// The table of features in the README: every scene and test that it names is there, and every scene
// of the gallery is in some row.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Row {
  std::string feature;
  std::vector<std::string> scenes;  ///< "cornell"; "study/*" is all of that folder
  std::vector<std::string> tests;   ///< files and folders below the repository
};

std::vector<std::string> quoted(const std::string& cell) {
  static const std::regex kCode("`([^`]+)`");
  std::vector<std::string> out;
  for (std::sregex_iterator it(cell.begin(), cell.end(), kCode), end; it != end; ++it) {
    out.push_back((*it)[1]);
  }
  return out;
}

std::vector<Row> feature_table() {
  static const std::regex kRow(R"(\| ([^|]+) \| ([^|]+) \| ([^|]+) \|)");
  std::vector<Row> rows;
  std::ifstream readme(std::string(BANDSAW_SOURCE) + "/README.md");
  bool inside = false;
  for (std::string line; std::getline(readme, line);) {
    if (line.starts_with("## ")) {
      inside = line == "## What it renders";
    }
    std::smatch cells;
    if (inside && std::regex_match(line, cells, kRow) &&
        cells[2].str().find('`') != std::string::npos) {
      rows.push_back({cells[1], quoted(cells[2]), quoted(cells[3])});
    }
  }
  return rows;
}

std::set<std::string> gallery() {
  const fs::path folder = BANDSAW_GALLERY;
  std::set<std::string> scenes;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".textproto") {
      scenes.insert(entry.path().lexically_relative(folder).replace_extension().string());
    }
  }
  return scenes;
}

/// The scenes that a name of the table means.
std::set<std::string> meant_by(const std::string& name, const std::set<std::string>& scenes) {
  const bool folder = name.ends_with("/*");
  std::set<std::string> out;
  std::copy_if(scenes.begin(), scenes.end(), std::inserter(out, out.end()),
               [&](const std::string& scene) {
                 return folder ? scene.starts_with(name.substr(0, name.size() - 1)) : scene == name;
               });
  return out;
}

TEST(FeatureTable, NamesEverySceneOfTheGalleryAndNoOther) {
  const std::set<std::string> scenes = gallery();
  const std::vector<Row> rows = feature_table();
  ASSERT_GE(rows.size(), 9u);
  std::set<std::string> named;
  for (const Row& row : rows) {
    for (const std::string& name : row.scenes) {
      const std::set<std::string> meant = meant_by(name, scenes);
      EXPECT_FALSE(meant.empty()) << row.feature << ": there is no scene " << name;
      named.insert(meant.begin(), meant.end());
    }
  }
  for (const std::string& scene : scenes) {
    EXPECT_TRUE(named.contains(scene)) << scene << " is in no row of the README's table";
  }
}

TEST(FeatureTable, NamesTestsThatAreThere) {
  for (const Row& row : feature_table()) {
    EXPECT_FALSE(row.tests.empty()) << row.feature;
    for (const std::string& test : row.tests) {
      EXPECT_TRUE(fs::exists(fs::path(BANDSAW_SOURCE) / "tests" / test)) << row.feature << test;
    }
  }
}

}  // namespace
