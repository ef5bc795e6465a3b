#pragma once

// Writes files atomically: temporary file in the same folder, fsync, rename, fsync of the folder.

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/base/file.h"

namespace bandsaw {

/// Writes the file. On any error the target is unchanged and no temporary file remains.
absl::Status write_file_atomically(const std::string& path, absl::Span<const std::byte> bytes);

/// Returns OK if write_file_atomically() could begin: the folder exists and is writable, and the
/// path is not a folder. Otherwise returns the system's error.
absl::Status check_can_be_written(const std::string& path);

}  // namespace bandsaw
