#pragma once

// Who rendered which rows of an image, kept beside it. For people to look at: an image without it
// is as good.

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// Rows that one worker rendered last.
struct RowsBy {
  RowRange rows;
  std::string worker;  ///< its name; empty: not known
  friend bool operator==(const RowsBy&, const RowsBy&) = default;
};

/// Whole or not at all.
absl::Status write_credits(const std::vector<RowsBy>& credits, const std::string& path);

/// NOT_FOUND: no such file. DATA_LOSS: damaged, saying how. RESOURCE_EXHAUSTED: far too long.
absl::StatusOr<std::vector<RowsBy>> read_credits(const std::string& path);

}  // namespace bandsaw::coordinator
