#pragma once

// The files of a study: figures (.csv) and a plot (.svg).

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "coordinator/cli/study/log_plot.h"

namespace bandsaw::coordinator {

/// INVALID_ARGUMENT: a name that ends in neither.
absl::Status check_study_outputs(const std::vector<std::string>& outputs);

/// Whether each can be written, before any work.
absl::Status check_study_writable(const std::vector<std::string>& outputs);

/// Each file whole or not at all; stops at the first error.
absl::Status write_study(const std::vector<std::string>& outputs, const std::string& csv,
                         const Plot& plot);

}  // namespace bandsaw::coordinator
