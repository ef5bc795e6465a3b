// Tests that the file bandsaw-worker runs on other machines without further files, because it needs
// only Linux and glibc. Also tests that the command `bandsaw` recognises this file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "coordinator/cli/machines/worker_file.h"
#include "tests/farm/farm_processes.h"
#include "tests/support/process.h"
#include "tests/support/sanitized.h"

namespace bandsaw::test {
namespace {

/// Returns the shared libraries that a program needs (the NEEDED entries of its ELF file).
std::set<std::string> libraries_of(const std::string& program) {
  const Finished read = run({"/usr/bin/readelf", "--dynamic", "--wide", program});
  EXPECT_EQ(read.code, 0) << read.err;
  std::set<std::string> libraries;
  std::istringstream lines(read.out);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find('[');
    if (line.find("(NEEDED)") != std::string::npos && begin != std::string::npos) {
      libraries.insert(line.substr(begin + 1, line.find(']') - begin - 1));
    }
  }
  return libraries;
}

TEST(WorkerFile, NeedsOnlyGlibc) {
  if (kSanitized) {
    GTEST_SKIP() << "a sanitizer brings libraries of its own";
  }
  const std::set<std::string> glibc = {"libc.so.6",
                                       "libm.so.6",
                                       "libdl.so.2",
                                       "libpthread.so.0",
                                       "librt.so.1",
                                       "ld-linux-x86-64.so.2",
                                       "ld-linux-aarch64.so.1"};
  const std::set<std::string> needed = libraries_of(BANDSAW_WORKER_BIN);
  EXPECT_TRUE(needed.contains("libc.so.6"));
  for (const std::string& library : needed) {
    EXPECT_TRUE(glibc.contains(library)) << library;
  }
}

// Unlike the worker, the command `bandsaw` is linked with the shared C++ library. If libraries_of()
// did not find this library, it could also miss a library of the worker.
TEST(WorkerFile, LibrariesOfTheCommandContainTheSharedCppLibrary) {
  EXPECT_TRUE(libraries_of(BANDSAW_BIN).contains("libstdc++.so.6"));
}

TEST(WorkerFile, ItsVersionIsReadWithoutRunningIt) {
  const auto program = coordinator::checked_worker_program(file_bytes(BANDSAW_WORKER_BIN),
                                                           coordinator::kThisMachine);
  ASSERT_TRUE(program.ok()) << program.status();
  EXPECT_EQ(run({BANDSAW_WORKER_BIN, "--version"}).out,
            "bandsaw-worker " + program->version + "\n");
}

TEST(WorkerFile, AnotherProgramIsNotAWorker) {
  const auto command = coordinator::checked_worker_program(file_bytes(BANDSAW_IMPORT_BIN),
                                                           coordinator::kThisMachine);
  EXPECT_THAT(command.status().message(), ::testing::HasSubstr("is no bandsaw-worker"));
}

}  // namespace
}  // namespace bandsaw::test
