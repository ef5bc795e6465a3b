#pragma once

// Parts of an image on disk: how it is to be shown, then band records (render/band_file.h). The
// beginning, little-endian: "BSWPART1", exposure (f64), tone (u64), hash of these (u64). A file of
// records alone is a part too.

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/image/display.h"
#include "renderlib/render/band_file.h"

namespace bandsaw::coordinator {

/// Writes the records as one file, whole or not at all.
absl::Status write_part(const std::string& path, const std::vector<BandRecord>& records,
                        const Display& display = {});

/// Calls `record` for each record of the file, until it returns an error, which is then returned;
/// else how the image is to be shown.
/// DATA_LOSS: the file is damaged or not a part; names it. NOT_FOUND, PERMISSION_DENIED, …: it
/// cannot be read.
absl::StatusOr<Display> read_part(const std::string& path,
                                  const std::function<absl::Status(const BandRecord&)>& record);

}  // namespace bandsaw::coordinator
