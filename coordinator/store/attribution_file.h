#pragma once

// Stores which worker rendered which rows of an image, in a file beside it. For display only: the
// image is valid without it.

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

/// Reads the file. NOT_FOUND: no such file. DATA_LOSS: damaged, with the reason.
/// RESOURCE_EXHAUSTED: far longer than any attribution.
absl::StatusOr<std::vector<RowsBy>> read_attribution(const std::string& path);

}  // namespace bandsaw::coordinator
