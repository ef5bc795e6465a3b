#pragma once

// Where reports go. A report never takes the place of a file that is not one.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// The files that the report of these images goes to: the one asked for, or beside each image with
/// its name and .json, or .report.json where .json is there and is something else (a scene may be);
/// each once. INVALID_ARGUMENT: a file is there and is no report. Other errors: its folder is not
/// there or cannot be written.
absl::StatusOr<std::vector<std::string>> report_files(const ReportOption& asked,
                                                      const std::vector<std::string>& outputs);

/// Whether an image may go to the file that is taken where none is named: a picture beside a model
/// may be its texture. INVALID_ARGUMENT: something is there, and no report of a render beside it.
/// Scene files own no picture of their name.
absl::Status check_default_output(const std::string& scene, const std::string& output);

/// check_outputs_writable (options/output.h), and check_default_output where none was asked for.
absl::Status check_outputs(const std::string& scene, const std::vector<std::string>& asked,
                           const std::vector<std::string>& outputs);

/// Each whole or not at all; stops at the first error, which says that the image is there.
absl::Status write_reports(const std::string& text, const std::vector<std::string>& files);

}  // namespace bandsaw::coordinator
