#pragma once

// Small files that only their owner may read: mode 0600 in a folder of mode 0700, written whole or
// not at all. (renderlib/base/atomic_file.h makes files for everybody, and proto does not depend on
// renderlib.)

#include <string>

#include "absl/status/statusor.h"

namespace bandsaw::link {

/// Makes the folder (and its parents) when there is none, with mode 0700. One that exists is left
/// as it is.
absl::Status make_private_folder(const std::string& folder);

/// NOT_FOUND: no such file. PERMISSION_DENIED: not ours to read, or readable by others (says how to
/// mend it).
absl::StatusOr<std::string> read_private_file(const std::string& path);

/// Temporary file of mode 0600, fsync, rename, fsync of the folder. Keeps what is there when it
/// fails.
absl::Status write_private_file(const std::string& path, const std::string& text);

}  // namespace bandsaw::link
