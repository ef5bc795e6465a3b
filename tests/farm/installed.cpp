// Copies the built programs into the folders of an installation: the programs to `bin`, workers of
// other architectures to `lib/bandsaw`.

#include "tests/farm/installed.h"

#include <filesystem>
#include <fstream>

namespace bandsaw::test {

namespace fs = std::filesystem;

Installed::Installed() {
  fs::create_directories(folder_ / "bin");
  fs::create_directories(folder_ / "lib/bandsaw");
  fs::copy_file(BANDSAW_BIN, bandsaw());
  fs::copy_file(BANDSAW_WORKER_BIN, folder_ / "bin/bandsaw-worker");
}

void Installed::put_aarch64_worker(const std::string& bytes) const {
  std::ofstream(aarch64_worker(), std::ios::binary) << bytes;
}

}  // namespace bandsaw::test
