// A temporary folder for tests, which the destructor removes with its contents.

#include "tests/support/temp_dir.h"

#include <cstdlib>
#include <filesystem>

#include "renderlib/base/check.h"

namespace bandsaw::test {

TempDir::TempDir() {
  std::string pattern = (std::filesystem::temp_directory_path() / "bandsaw-test-XXXXXX").string();
  BANDSAW_CHECK(mkdtemp(pattern.data()) != nullptr, "a test can make a temporary folder");
  path_ = pattern;
}

TempDir::~TempDir() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);  // a folder that stays does not fail the test
}

}  // namespace bandsaw::test
