#pragma once

// Stores which worker rendered which rows of an image, in a file beside the image. The file is for
// display only: the image is valid without the file.

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// Rows of the image and the worker that rendered them last.
struct RowsBy {
  RowRange rows;
  std::string worker;  ///< its name; empty: unknown
  friend bool operator==(const RowsBy&, const RowsBy&) = default;
};

/// Writes the file atomically.
absl::Status write_attribution(const std::vector<RowsBy>& attribution, const std::string& path);

/// Reads the file. NOT_FOUND: there is no such file. DATA_LOSS: the file is damaged; the message
/// has the reason. RESOURCE_EXHAUSTED: the file is far longer than any attribution.
absl::StatusOr<std::vector<RowsBy>> read_attribution(const std::string& path);

}  // namespace bandsaw::coordinator
