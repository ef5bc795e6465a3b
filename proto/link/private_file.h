#pragma once

// Small files that only their owner may read: mode 0600 in a folder of mode 0700, written
// atomically. renderlib/base/atomic_file.h is not used here, because it writes files that everybody
// may read, and because proto/link does not depend on renderlib.

#include <string>

#include "absl/status/statusor.h"

namespace bandsaw::link {

/// Creates the folder and its parents with mode 0700. An existing folder is not changed.
absl::Status make_private_folder(const std::string& folder);

/// Reads a file of at most 1 MiB. NOT_FOUND: no such file. PERMISSION_DENIED: not readable by this
/// user, or readable by others (the message says how to repair it). RESOURCE_EXHAUSTED: larger.
absl::StatusOr<std::string> read_private_file(const std::string& path);

/// Writes a file of mode 0600 by temporary file, fsync, rename and fsync of the folder. After an
/// error the previous file is kept, unless only the fsync of the folder failed.
absl::Status write_private_file(const std::string& path, const std::string& text);

}  // namespace bandsaw::link
