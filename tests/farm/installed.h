#pragma once

// An installation of Bandsaw in a temporary folder, without workers of other architectures at
// first.

#include <string>

#include "tests/support/temp_dir.h"

namespace bandsaw::test {

/// The command and its worker, copied into a folder of the test. So only those programs of other
/// architectures are installed that the test adds.
class Installed {
 public:
  Installed();
  std::string bandsaw() const { return folder_ / "bin/bandsaw"; }
  /// Path at which the program for aarch64 machines is expected. Its folder exists. The file exists
  /// only after put_aarch64_worker().
  std::string aarch64_worker() const { return folder_ / "lib/bandsaw/bandsaw-worker-aarch64"; }
  /// Writes `bytes` to the file aarch64_worker().
  void put_aarch64_worker(const std::string& bytes) const;

 private:
  TempDir folder_;
};

}  // namespace bandsaw::test
