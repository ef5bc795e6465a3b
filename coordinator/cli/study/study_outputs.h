#pragma once

// Output files of a study: data (.csv) and a plot (.svg).

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "coordinator/cli/study/log_plot.h"

namespace bandsaw::coordinator {

/// INVALID_ARGUMENT: a name has another suffix.
absl::Status check_study_outputs(const std::vector<std::string>& outputs);

/// Checks that each file can be written, before any work is done.
absl::Status check_study_writable(const std::vector<std::string>& outputs);

/// Writes each file atomically; stops at the first error.
absl::Status write_study(const std::vector<std::string>& outputs, const std::string& csv,
                         const Plot& plot);

}  // namespace bandsaw::coordinator
