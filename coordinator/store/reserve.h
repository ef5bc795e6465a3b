#pragma once

// A file that reserves disk space. When the disk is full the file is removed, so that the journal
// and other small files can be written, and a job can be cancelled to free its space.

#include <cstdint>
#include <string>
#include <utility>

#include "absl/status/status.h"

namespace bandsaw::coordinator {

/// Not thread-safe.
class Reserve {
 public:
  static constexpr std::uint64_t kBytes = 16ull << 20;

  /// `path`: path of the file, which may exist from an earlier run.
  explicit Reserve(std::string path) : path_(std::move(path)) {}

  /// Creates the file unless it exists with its full size. RESOURCE_EXHAUSTED: the disk has too
  /// little space. On a file system that cannot reserve space the file is empty, and releasing it
  /// frees nothing.
  absl::Status hold();
  /// Removes the file. Returns false if there was none, or it cannot be removed.
  bool release();

 private:
  std::string path_;
};

}  // namespace bandsaw::coordinator
