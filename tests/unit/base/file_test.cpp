// Opening files for reading: pipes and folders are refused, links only followed if that is allowed.

#include "renderlib/base/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "renderlib/base/mapped_file.h"
#include "tests/support/temp_dir.h"

namespace bandsaw {
namespace {

TEST(File, OtherThanRegularFilesAreRefusedAtOnce) {
  const test::TempDir folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  // A plain open() of a pipe would wait for a writer.
  EXPECT_EQ(File::open_regular(pipe).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(MappedFile::open(folder.path()).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(File::open_regular(folder / "none").status().code(), absl::StatusCode::kNotFound);
}

TEST(File, ALinkIsFollowedOnlyIfAllowed) {
  const test::TempDir folder;
  ASSERT_TRUE(File::open(folder / "file", O_WRONLY | O_CREAT).ok());
  ASSERT_EQ(symlink((folder / "file").c_str(), (folder / "link").c_str()), 0);
  EXPECT_TRUE(MappedFile::open(folder / "link").ok());
  EXPECT_FALSE(MappedFile::open(folder / "link", O_NOFOLLOW).ok());
}

}  // namespace
}  // namespace bandsaw
