#pragma once

// Parts of an image on disk: files of band records (render/band_file.h).

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/render/band_file.h"

namespace bandsaw::coordinator {

/// Writes the records as one file, whole or not at all.
absl::Status write_part(const std::string& path, const std::vector<BandRecord>& records);

/// Calls `record` for each record of the file, until it returns an error, which is then returned.
/// DATA_LOSS: the file is damaged or not a part; names it. NOT_FOUND, PERMISSION_DENIED, …: it
/// cannot be read.
absl::Status read_part(const std::string& path,
                       const std::function<absl::Status(const BandRecord&)>& record);

}  // namespace bandsaw::coordinator
