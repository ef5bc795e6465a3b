#pragma once

// Room on the disk that is kept for the time when it is full: the journal and other small files are
// written then, so that a job can be cancelled and its room be given back.

#include <cstdint>
#include <string>
#include <utility>

#include "absl/status/status.h"

namespace bandsaw::coordinator {

/// A file that holds room and nothing else. Used by one thread at a time.
class Reserve {
 public:
  static constexpr std::uint64_t kBytes = 16ull << 20;

  /// `path`: of the file, which may be there from an earlier life.
  explicit Reserve(std::string path) : path_(std::move(path)) {}

  /// Makes the file unless it is there and whole. RESOURCE_EXHAUSTED: the disk has no such room. A
  /// file system that cannot reserve holds an empty file, and releasing it gives nothing.
  absl::Status hold();
  /// Removes the file. Returns false when there was none, or it cannot be removed.
  bool release();

 private:
  std::string path_;
};

}  // namespace bandsaw::coordinator
