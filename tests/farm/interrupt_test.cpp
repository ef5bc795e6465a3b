// A signal that comes after a scene was imported ends the command and leaves no temporary files.

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include "absl/strings/str_cat.h"
#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

/// Writes a PLY file with a grid of side * side vertices.
void write_grid(const std::string& path, std::int32_t side) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << side * side
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
       << 2 * (side - 1) * (side - 1) << "\nproperty list uchar int vertex_indices\nend_header\n";
  const auto write = [&file](const auto& values) {
    file.write(reinterpret_cast<const char*>(values.data()), sizeof values);
  };
  for (std::int32_t i = 0; i < side * side; ++i) {
    const auto x = static_cast<float>(i % side);
    const auto y = static_cast<float>(i / side);
    write(std::array<float, 3>{x, y, static_cast<float>(i % 7)});
  }
  for (std::int32_t i = 0; i < side * (side - 1); ++i) {
    if (i % side != side - 1) {
      file.put(3);
      write(std::array<std::int32_t, 3>{i, i + 1, i + side});
      file.put(3);
      write(std::array<std::int32_t, 3>{i + 1, i + side + 1, i + side});
    }
  }
}

/// Returns true if the importer has written a package to a folder in `temporary`.
bool is_imported(const std::string& temporary) {
  for (const auto& entry : std::filesystem::directory_iterator(temporary)) {
    if (std::filesystem::exists(entry.path() / "manifest")) {
      return true;
    }
  }
  return false;
}

/// Returns true if the process `pid` has no child. The first thread of the process, whose id is
/// also `pid`, starts all children.
bool has_no_child(pid_t pid) {
  std::ifstream children(absl::StrCat("/proc/", pid, "/task/", pid, "/children"));
  std::string first;
  return !(children >> first);
}

// The signal comes as soon as the importer has ended, while the scene is decoded and its BVH is
// built. On a busy machine the signal may come after the command has ended; then the exit code is
// 0.
TEST(Interrupt, AnInterruptAfterTheImportLeavesNoTemporaryFiles) {
  const TempDir folder;
  write_grid(folder / "grid.ply", 800);  // so large that the build of the BVH takes a while
  const std::string temporary = folder / "tmp";
  std::filesystem::create_directory(temporary);
  Process info = Process::start({BANDSAW_BIN, "info", folder / "grid.ply"},
                                {absl::StrCat("TMPDIR=", temporary)});
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!(is_imported(temporary) && has_no_child(info.pid())) &&
         std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  info.signal(SIGINT);
  const std::optional<int> code = info.wait();
  EXPECT_TRUE(code == 130 || code == 0) << info.err();
  EXPECT_TRUE(std::filesystem::is_empty(temporary));
}

}  // namespace
}  // namespace bandsaw::test
