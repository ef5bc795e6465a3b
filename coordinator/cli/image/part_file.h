#pragma once

// Files with parts of an image: a header with the display settings, then band records
// (render/band_file.h). Header, little-endian: "BSWPART1", exposure (f64), tone (u64), hash of
// these two (u64). A file of records without a header is a part as well.

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/image/display.h"
#include "renderlib/render/band_file.h"

namespace bandsaw::coordinator {

/// Writes the records to one file, atomically.
absl::Status write_part(const std::string& path, const std::vector<BandRecord>& records,
                        const Display& display = {});

/// Calls `record` for each record of the file. If it returns an error, stops and returns that;
/// otherwise returns the display settings. DATA_LOSS: the file is damaged or not a part; the
/// message names it. NOT_FOUND, PERMISSION_DENIED, …: it cannot be read.
absl::StatusOr<Display> read_part(const std::string& path,
                                  const std::function<absl::Status(const BandRecord&)>& record);

}  // namespace bandsaw::coordinator
