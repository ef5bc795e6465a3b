// Temporary folders: only their owner can read them, and they are removed with their contents. If
// no folder can be made, the error names the parent folder.

#include "coordinator/store/scratch_folder.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

namespace fs = std::filesystem;

TEST(ScratchFolder, IsPrivateAndIsRemovedWithItsContents) {
  const test::TempDir parent;
  {
    const auto folder = ScratchFolder::make("test", parent.path());
    ASSERT_TRUE(folder.ok()) << folder.status();
    const fs::path path = (*folder)->path();
    EXPECT_EQ(path.parent_path(), parent.path());
    EXPECT_THAT(path.filename().string(), ::testing::StartsWith("bandsaw-test-"));
    EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_all);
    std::ofstream(path / "file") << "text";
    fs::create_directories(path / "inner" / "most");
  }
  EXPECT_TRUE(fs::is_empty(parent.path()));
}

TEST(ScratchFolder, TheErrorNamesTheParentThatIsMissing) {
  const test::TempDir parent;
  const std::string missing = parent.path() + "/missing";
  const absl::Status status = ScratchFolder::make("test", missing).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(status.message()), ::testing::HasSubstr(missing));
}

}  // namespace
}  // namespace bandsaw::coordinator
