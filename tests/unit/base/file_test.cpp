// Opening files for reading: pipes and folders are refused, and links are followed only if that is
// allowed. The error of a bad sector differs from other errors of reading.

#include "renderlib/base/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>

#include "renderlib/base/mapped_file.h"
#include "tests/support/temp_dir.h"

namespace bandsaw {
namespace {

TEST(File, FilesThatAreNotRegularAreRefusedAtOnce) {
  const test::TempDir folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  // A plain open() of a pipe would wait for a writer.
  EXPECT_EQ(File::open_regular(pipe).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(MappedFile::open(folder.path()).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(File::open_regular(folder / "none").status().code(), absl::StatusCode::kNotFound);
}

// Reading /proc/self/mem at address 0 fails with EIO, as reading a bad sector does.
TEST(File, IsUnreadableIsTrueForEioButNotForAnEmptyFile) {
  const auto memory = File::open("/proc/self/mem", O_RDONLY);
  ASSERT_TRUE(memory.ok()) << memory.status();
  std::array<std::byte, 1> byte{};
  EXPECT_TRUE(is_unreadable(memory->read(0, absl::MakeSpan(byte))));
  const test::TempDir folder;
  const auto empty = File::open(folder / "empty", O_RDWR | O_CREAT);
  ASSERT_TRUE(empty.ok()) << empty.status();
  EXPECT_FALSE(is_unreadable(empty->read(0, absl::MakeSpan(byte))));
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
