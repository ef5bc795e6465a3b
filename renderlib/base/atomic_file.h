#pragma once

// Writes files atomically: the bytes go to a temporary file in the same folder, which is synced and
// renamed; then the folder is synced. So a crash leaves the old file or the complete new one.

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/base/file.h"

namespace bandsaw {

/// Writes the file. Returns FAILED_PRECONDITION if the path exists and is not a regular file,
/// otherwise the system's error (file.h, errno_status). After an error no temporary file remains.
/// If only the sync of the folder failed, the target is the new file. After any other error the
/// target is unchanged.
absl::Status write_file_atomically(const std::string& path, absl::Span<const std::byte> bytes);

/// Gives the file `part`, which another program has written, its final name `path`. Both are in
/// the same folder. The function syncs `part`, renames it to `path`, and syncs the folder. A file
/// that already has the name `path` is replaced. Returns the system's error. After an error `part`
/// still exists, unless only the sync of the folder failed.
absl::Status name_file(const std::string& part, const std::string& path);

/// Returns OK if write_file_atomically() could begin: the folder exists and is writable, the path
/// is a regular file or does not exist, and the name of the temporary file is not too long. Returns
/// FAILED_PRECONDITION if the path is neither a regular file nor a folder, otherwise the system's
/// error.
absl::Status check_can_be_written(const std::string& path);

}  // namespace bandsaw
