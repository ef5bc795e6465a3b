// Checks the README: it has its commands, headings and picture, and each of its `sh` blocks runs.
// Every block runs unchanged in a new folder that has links to the checkout's files. The block that
// runs the tests is left out.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::test {
namespace {

namespace fs = std::filesystem;

/// Returns the text of each `sh` block of the Markdown file at `path`.
std::vector<std::string> shell_blocks(const std::string& path) {
  std::vector<std::string> blocks;
  std::ifstream file(path);
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line == "```sh") {
      inside = true;
      blocks.emplace_back();
    } else if (line == "```") {
      inside = false;
    } else if (inside) {
      blocks.back() += line + "\n";
    }
  }
  return blocks;
}

// Makes symbolic links to the checkout in a folder, so that a block may write files beside them
// without changing the checkout.
void link_checkout(const std::string& folder) {
  for (const char* name : {"renderlib", "deploy", "tests", "proto", "CMakeLists.txt"}) {
    fs::create_symlink(fs::path(BANDSAW_SOURCE) / name, fs::path(folder) / name);
  }
}

TEST(Readme, EveryShellBlockRuns) {
  const std::vector<std::string> blocks = shell_blocks(std::string(BANDSAW_SOURCE) + "/README.md");
  ASSERT_GE(blocks.size(), 3u);
  const std::string build = fs::path(BANDSAW_BIN).parent_path().parent_path();
  for (const std::string& block : blocks) {
    if (block == "deploy/test.sh\n") {
      continue;  // this block runs the tests, and this test with them
    }
    TempDir folder;
    link_checkout(folder.path());
    const std::string script =
        "set -euo pipefail; trap 'kill $(jobs -p) 2>/dev/null || true' EXIT\n"
        "cd '" +
        folder.path() + "'\n" + block;
    const Finished finished =
        run({"/bin/bash", "-c", script},
            {"BANDSAW_BUILD=" + build, "BANDSAW_DEMO_SAMPLES=2", "HOME=" + folder.path(),
             "PATH=" + build + "/bin:/usr/bin:/bin"});
    EXPECT_EQ(finished.code, 0) << block << "\n" << finished.out << finished.err;
  }
}

// The README has these commands and headings, and a picture that exists.
TEST(Readme, HasItsCommandsHeadingsAndPicture) {
  std::ifstream file(std::string(BANDSAW_SOURCE) + "/README.md");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  for (const char* part : {"deploy/demo.sh", "deploy/test.sh", "## Guarantees", "## Limits",
                           "## Why one would use it", "## Source tree"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
  const std::regex picture(R"(!\[[^\]]*\]\(([^)]+)\))");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(text, match, picture));
  EXPECT_TRUE(fs::exists(fs::path(BANDSAW_SOURCE) / match[1].str())) << match[1];
}

}  // namespace
}  // namespace bandsaw::test
