// Tests files that are written completely or not at all, and the errors if a file cannot be
// written.

#include "renderlib/base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>
#include <vector>

#include "tests/support/temp_dir.h"

namespace bandsaw {
namespace {

absl::Span<const std::byte> bytes(const std::string& text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

std::string content(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(AtomicFile, WritesAndReplacesWholeFiles) {
  const test::TempDir dir;
  EXPECT_EQ(write_file_atomically(dir / "a", bytes("first")), absl::OkStatus());
  EXPECT_EQ(write_file_atomically(dir / "a", bytes("2")), absl::OkStatus());
  EXPECT_EQ(content(dir / "a"), "2");
  EXPECT_EQ(write_file_atomically(dir / "empty", {}), absl::OkStatus());
  EXPECT_EQ(content(dir / "empty"), "");
  EXPECT_EQ(files_in(dir.path()), 2u);
}

TEST(AtomicFile, RenamesAFileThatAnotherProgramHasWritten) {
  const test::TempDir dir;
  std::ofstream(dir / "a.part") << "new";
  std::ofstream(dir / "a") << "old";
  EXPECT_EQ(name_file(dir / "a.part", dir / "a"), absl::OkStatus());
  EXPECT_EQ(content(dir / "a"), "new");
  EXPECT_EQ(files_in(dir.path()), 1u);
  EXPECT_EQ(name_file(dir / "a.part", dir / "a").code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(content(dir / "a"), "new");
}

TEST(AtomicFile, HasTheModeOfAnyNewFile) {
  const test::TempDir dir;
  ASSERT_EQ(write_file_atomically(dir / "a", bytes("x")), absl::OkStatus());
  std::ofstream(dir / "b") << "x";
  struct stat a {};
  struct stat b {};
  ASSERT_EQ(::stat((dir / "a").c_str(), &a), 0);
  ASSERT_EQ(::stat((dir / "b").c_str(), &b), 0);
  EXPECT_EQ(a.st_mode, b.st_mode);
}

TEST(AtomicFile, NamesTheFileIfItsFolderIsMissing) {
  const test::TempDir dir;
  const absl::Status status = write_file_atomically(dir / "no/such/a.png", bytes("x"));
  EXPECT_EQ(status.code(), absl::StatusCode::kNotFound);
  EXPECT_NE(status.message().find("a.png"), std::string::npos) << status;
}

TEST(AtomicFile, RefusesTargetsThatAreNoFiles) {
  const test::TempDir dir;
  EXPECT_EQ(write_file_atomically(dir.path(), bytes("x")).code(),
            absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(write_file_atomically("/dev/full", bytes("x")).code(),
            absl::StatusCode::kFailedPrecondition);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

// A program makes this check before long work whose result it will write to the file. A file is
// first written under a longer, temporary name. So a name of 250 bytes is too long, although the
// file system allows 255 bytes.
TEST(AtomicFile, ChecksBeforehandWhetherAFileCanBeWritten) {
  const test::TempDir dir;
  EXPECT_TRUE(check_can_be_written(dir / "a").ok());
  ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
  EXPECT_FALSE(check_can_be_written(dir / "pipe").ok());
  EXPECT_TRUE(check_can_be_written(dir / std::string(230, 'n')).ok());
  EXPECT_TRUE(write_file_atomically(dir / std::string(230, 'n'), bytes("x")).ok());
  EXPECT_FALSE(check_can_be_written(dir / std::string(250, 'n')).ok());
}

TEST(AtomicFile, LeavesNoFileInAReadOnlyFolder) {
  if (::geteuid() == 0) {
    GTEST_SKIP() << "root may write everywhere";
  }
  const test::TempDir dir;
  ASSERT_EQ(::chmod(dir.path().c_str(), 0500), 0);
  EXPECT_EQ(write_file_atomically(dir / "a", bytes("x")).code(),
            absl::StatusCode::kPermissionDenied);
  ASSERT_EQ(::chmod(dir.path().c_str(), 0700), 0);
  EXPECT_EQ(files_in(dir.path()), 0u);
}

/// Tries to write a file that is larger than this process may write. write() then fails half-way,
/// as on a full disk. Returns 0 if the error was reported, 2 if it was not, and 3 if the limit
/// could not be set. MUST be called in a child process, because the limit applies to the whole
/// process.
int write_with_limit(const std::string& path) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit = {1000, 1000};
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) {
    return 3;
  }
  return write_file_atomically(path, bytes(std::string(5000, 'x'))).ok() ? 2 : 0;
}

TEST(AtomicFile, KeepsTheOldFileWhenWritingFailsHalfWay) {
  const test::TempDir dir;
  ASSERT_EQ(write_file_atomically(dir / "a", bytes("old")), absl::OkStatus());
  EXPECT_EXIT(std::_Exit(write_with_limit(dir / "a")), testing::ExitedWithCode(0), "");
  EXPECT_EQ(content(dir / "a"), "old");
  EXPECT_EQ(files_in(dir.path()), 1u);
}

TEST(AtomicFile, IsCompleteIfSeveralThreadsWriteTheSamePath) {
  const test::TempDir dir;
  std::vector<std::thread> writers;
  for (int writer = 0; writer < 4; ++writer) {
    writers.emplace_back([&dir, writer] {
      const std::string text(20000, static_cast<char>('a' + writer));
      for (int round = 0; round < 5; ++round) {
        EXPECT_EQ(write_file_atomically(dir / "a", bytes(text)), absl::OkStatus());
      }
    });
  }
  for (std::thread& writer : writers) {
    writer.join();
  }
  const std::string text = content(dir / "a");
  EXPECT_EQ(text, std::string(20000, text.at(0)));
  EXPECT_EQ(files_in(dir.path()), 1u);
}

TEST(ErrnoStatus, HasTheCanonicalCode) {
  EXPECT_EQ(errno_status(ENOENT, "x").code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(errno_status(EACCES, "x").code(), absl::StatusCode::kPermissionDenied);
  EXPECT_EQ(errno_status(ENOSPC, "x").code(), absl::StatusCode::kResourceExhausted);
  EXPECT_NE(errno_status(ENOENT, "cannot read y").message().find("cannot read y: "),
            std::string::npos);
}

}  // namespace
}  // namespace bandsaw
