#pragma once

// Checks and writes the files of `bandsaw study`: the data (.csv) and the plot (.svg).

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "coordinator/cli/study/log_plot.h"

namespace bandsaw::coordinator {

/// Checks the names. INVALID_ARGUMENT: a name ends in neither .csv nor .svg.
absl::Status check_study_outputs(const std::vector<std::string>& outputs);

/// Checks that each file can be written, before any work is done.
absl::Status check_study_writable(const std::vector<std::string>& outputs);

/// Writes `csv` to each file whose name ends in .csv, and `plot` to each file whose name ends in
/// .svg. Each file is written atomically. Stops at the first error.
absl::Status write_study(const std::vector<std::string>& outputs, const std::string& csv,
                         const Plot& plot);

}  // namespace bandsaw::coordinator
