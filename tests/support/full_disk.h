#pragma once

// A disk that takes no more, without a disk: this process may not write any file beyond a size.
// What fails is the real call in the real place (EFBIG instead of ENOSPC).

#include <cstdint>

namespace bandsaw::test {

class FullDisk {
 public:
  /// From now on no file grows beyond `bytes`, in the whole process, until `release` or the end.
  explicit FullDisk(std::uint64_t bytes);
  ~FullDisk() { release(); }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  void release();

 private:
  std::uint64_t before_ = 0;
};

}  // namespace bandsaw::test
