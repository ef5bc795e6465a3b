#pragma once

// Chooses and writes the report files of an image (report.h). A report never replaces a file that
// is not a report.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// Returns the files for the report of the images `outputs`. `given` is the option --report. If it
/// is "none", there is no file. If it names a file, there is only that file. By default, there is a
/// file beside each image. That file has the image's name with .json, or with .report.json if the
/// .json file exists and is not a report (it may be a scene). A name appears once.
/// INVALID_ARGUMENT: a file exists and is not a report. Other errors: the folder does not exist or
/// is not writable.
absl::StatusOr<std::vector<std::string>> report_files(const ReportOption& given,
                                                      const std::vector<std::string>& outputs);

/// Checks if an image of `scene` may be written to the default file `output`, which has the name of
/// the scene with another suffix. A model may have a texture of that name. So if `scene` is no
/// scene file (.textproto or .json), an existing file may be replaced only if a report is beside
/// it. For a scene file, an existing file may always be replaced. INVALID_ARGUMENT: the file exists
/// and may not be replaced.
absl::Status check_default_output(const std::string& scene, const std::string& output);

/// Checks that `outputs` can be written. If the user named none (`given` is empty), also calls
/// check_default_output(). Errors: those of check_outputs_writable (output.h) and of
/// check_default_output().
absl::Status check_outputs(const std::string& scene, const std::vector<std::string>& given,
                           const std::vector<std::string>& outputs);

/// Writes `text` to each file, atomically. Stops at the first error, whose message says that the
/// image is written.
absl::Status write_reports(const std::string& text, const std::vector<std::string>& files);

}  // namespace bandsaw::coordinator
