#pragma once

// Chooses and writes report files. A report never replaces a file that is not a report.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// Returns the files for the report of these images, each once: the requested file, or for each
/// image a file of the same name with .json, or with .report.json if the .json file exists and is
/// not a report (it may be a scene). INVALID_ARGUMENT: a file exists and is not a report. Other
/// errors: the folder does not exist or is not writable.
absl::StatusOr<std::vector<std::string>> report_files(const ReportOption& given,
                                                      const std::vector<std::string>& outputs);

/// Checks if an image may be written to the default output file. A picture beside a model may be
/// its texture, so an existing file is replaced only if it has a render report beside it.
/// INVALID_ARGUMENT: the file exists and has no report. Not checked for scene files, which do not
/// use a picture of their own name.
absl::Status check_default_output(const std::string& scene, const std::string& output);

/// Calls check_outputs_writable (image/output.h), and check_default_output if no output was
/// given.
absl::Status check_outputs(const std::string& scene, const std::vector<std::string>& given,
                           const std::vector<std::string>& outputs);

/// Writes each file atomically. Stops at the first error, whose message says that the image exists.
absl::Status write_reports(const std::string& text, const std::vector<std::string>& files);

}  // namespace bandsaw::coordinator
