// The coordinator's data folder: its permissions, lock and format, and the reserve, a file that
// keeps disk space free for the journal.

#include "coordinator/store/data_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "coordinator/store/reserve.h"
#include "tests/support/full_disk.h"
#include "tests/support/temp_dir.h"
#include "tests/unit/store/test_files.h"

namespace bandsaw::coordinator {
namespace {

using testing::HasSubstr;

TEST(DataFolder, IsReadableByItsOwnerOnly) {
  const test::TempDir temp;
  const auto folder = DataFolder::open(temp / "data");
  ASSERT_TRUE(folder.ok()) << folder.status();
  struct stat info {};
  ASSERT_EQ(::stat((temp / "data").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0700u);
  EXPECT_TRUE(file_exists(folder->blobs()));
  EXPECT_TRUE(file_exists(folder->jobs()));
}

TEST(DataFolder, CanBeOpenOnlyOnceAtATime) {
  const test::TempDir temp;
  {
    const auto first = DataFolder::open(temp / "data");
    ASSERT_TRUE(first.ok());
    const absl::Status second = DataFolder::open(temp / "data").status();
    EXPECT_EQ(second.code(), absl::StatusCode::kFailedPrecondition);
    EXPECT_THAT(std::string(second.message()), HasSubstr(temp / "data"));
    EXPECT_THAT(std::string(second.message()), HasSubstr(std::to_string(::getpid())));
  }
  EXPECT_TRUE(DataFolder::open(temp / "data").ok());
}

TEST(DataFolder, AFolderOfAnotherFormatIsRefused) {
  const test::TempDir temp;
  ASSERT_TRUE(DataFolder::open(temp / "data").ok());
  write_all(temp / "data/format", "bandsaw data 2\n");
  const absl::Status status = DataFolder::open(temp / "data").status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(status.message()), HasSubstr("bandsaw data 2"));
}

TEST(DataFolder, AFolderWithoutItsParentIsNotFound) {
  const test::TempDir temp;
  EXPECT_EQ(DataFolder::open(temp / "no/data").status().code(), absl::StatusCode::kNotFound);
}

TEST(DataFolder, IsOpenedOnAFullDisk) {
  const test::TempDir temp;
  ASSERT_TRUE(DataFolder::open(temp / "data").ok());
  const test::FullDisk full(0);
  const auto folder = DataFolder::open(temp / "data");
  EXPECT_TRUE(folder.ok()) << folder.status();
}

TEST(Reserve, IsHeldReleasedAndHeldAgain) {
  const test::TempDir temp;
  Reserve reserve(temp / "reserve");
  EXPECT_FALSE(reserve.release());
  ASSERT_TRUE(reserve.hold().ok());
  struct stat info {};
  ASSERT_EQ(::stat((temp / "reserve").c_str(), &info), 0);
  EXPECT_GE(static_cast<std::uint64_t>(info.st_blocks) * 512, Reserve::kBytes);
  EXPECT_TRUE(Reserve(temp / "reserve").hold().ok()) << "a file that exists must be accepted";
  EXPECT_TRUE(reserve.release());
  EXPECT_FALSE(file_exists(temp / "reserve"));
  {
    const test::FullDisk full(1000);  // no file can grow beyond 1000 bytes
    EXPECT_EQ(reserve.hold().code(), absl::StatusCode::kResourceExhausted);
    EXPECT_FALSE(file_exists(temp / "reserve"));
  }
  EXPECT_TRUE(reserve.hold().ok());
}

// To find out if the disk has space, the probe writes a file, and then removes the file.
TEST(DataFolder, TheProbeFailsWhileTheDiskIsFull) {
  const test::TempDir temp;
  EXPECT_TRUE(probe_disk(temp.path()).ok());
  {
    const test::FullDisk full(1000);
    EXPECT_FALSE(probe_disk(temp.path()).ok());
  }
  EXPECT_TRUE(probe_disk(temp.path()).ok());
  EXPECT_EQ(::rmdir(temp.path().c_str()), 0) << "the probe must leave no file";
}

}  // namespace
}  // namespace bandsaw::coordinator
