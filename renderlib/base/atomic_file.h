#pragma once

// Whole files or none: temporary file in the same folder, fsync, rename, fsync of the folder.

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/base/file.h"

namespace bandsaw {

/// On any error nothing is left behind and the target is unchanged.
absl::Status write_file_atomically(const std::string& path, absl::Span<const std::byte> bytes);

/// Whether write_file_atomically would be able to begin: the folder exists and can be written, and
/// the path is no folder. Otherwise the system's reason.
absl::Status check_can_be_written(const std::string& path);

}  // namespace bandsaw
