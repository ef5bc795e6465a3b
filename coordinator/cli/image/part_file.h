#pragma once

// Files (.band) with parts of an image, which `render --rows` writes and `stitch` joins. A file has
// a header with the display settings, then records of bands (renderlib/render/band_file.h). A band
// is a range of rows with the sums of their samples. Header, little-endian: "BSWPART1", exposure
// (f64), tone (u64), hash of these two (u64). A file of records without a header is a part as well.

#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/image/display.h"
#include "renderlib/render/band_file.h"

namespace bandsaw::coordinator {

/// Writes a header with the exposure and tone of `display`, and the records, to one file,
/// atomically.
absl::Status write_part(const std::string& path, const std::vector<BandRecord>& records,
                        const Display& display = {});

/// Calls `record` for each record of the file. If `record` returns an error, stops and returns that
/// error. Otherwise returns the display settings in the header, or the defaults without a header.
/// DATA_LOSS: the file is damaged or no part; the message names it. NOT_FOUND, PERMISSION_DENIED,
/// …: the file cannot be read.
absl::StatusOr<Display> read_part(const std::string& path,
                                  const std::function<absl::Status(const BandRecord&)>& record);

}  // namespace bandsaw::coordinator
