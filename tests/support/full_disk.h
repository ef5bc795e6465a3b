#pragma once

// Simulates a full disk by limiting the size of files that this process may write. So the write
// itself fails, at the place where it would fail on a full disk. The error is EFBIG instead of
// ENOSPC.

#include <cstdint>

namespace bandsaw::test {

class FullDisk {
 public:
  /// Until `release` or the destructor, no file of the whole process can grow beyond `bytes`.
  explicit FullDisk(std::uint64_t bytes);
  ~FullDisk() { release(); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  void release();

 private:
  std::uint64_t before_ = 0;
};

}  // namespace bandsaw::test
