// A file counts as a report if its first bytes are kReportBegins. Any other existing file is never
// replaced by a report.

#include "coordinator/cli/image/report_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <span>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/image/report.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

namespace fs = std::filesystem;

/// Returns true if the path exists, also if it is a symbolic link whose target does not exist.
bool is_there(const std::string& path) {
  std::error_code error;
  return fs::exists(fs::symlink_status(path, error));
}

bool is_report(const std::string& path) {
  std::string begins(sizeof kReportBegins - 1, '\0');
  std::ifstream file(path, std::ios::binary);
  return file.read(begins.data(), static_cast<std::streamsize>(begins.size())) &&
         begins == kReportBegins;
}

/// Returns true if a report may be written to the path: no file exists, or the file is a report.
bool is_free(const std::string& path) { return !is_there(path) || is_report(path); }

/// Makes the error for a file that exists and is no report.
absl::Status taken(const std::string& path) {
  return absl::InvalidArgumentError(absl::StrCat(
      path, ": exists and is no report; choose another with --report FILE, or --report none"));
}

/// Returns the name of the report beside an image: with .json if that name is free, otherwise with
/// .report.json.
std::string beside(const std::string& output) {
  const fs::path path(output);
  const std::string plain = fs::path(path).replace_extension(".json");
  return is_free(plain) ? plain : std::string(fs::path(path).replace_extension(".report.json"));
}

}  // namespace

absl::StatusOr<std::vector<std::string>> report_files(const ReportOption& given,
                                                      const std::vector<std::string>& outputs) {
  std::vector<std::string> files;
  if (given.file == "none") {
    return files;
  }
  if (!given.file.empty()) {
    files.push_back(given.file);
  } else {
    for (const std::string& output : outputs) {
      files.push_back(beside(output));
    }
    std::sort(files.begin(), files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
  }
  for (const std::string& file : files) {
    if (!is_free(file)) {
      return taken(file);
    }
    RETURN_IF_ERROR(check_can_be_written(file));
  }
  return files;
}

absl::Status check_default_output(const std::string& scene, const std::string& output) {
  const bool is_scene_file =
      absl::EndsWithIgnoreCase(scene, ".textproto") || absl::EndsWithIgnoreCase(scene, ".json");
  const fs::path path(output);
  if (is_scene_file || !is_there(output) || is_report(fs::path(path).replace_extension(".json")) ||
      is_report(fs::path(path).replace_extension(".report.json"))) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      absl::StrCat(output,
                   ": exists and may belong to the model, because no render report is "
                   "beside it; name a file with -o"));
}

absl::Status check_outputs(const std::string& scene, const std::vector<std::string>& given,
                           const std::vector<std::string>& outputs) {
  RETURN_IF_ERROR(check_outputs_writable(outputs));
  return given.empty() && !outputs.empty() ? check_default_output(scene, outputs.front())
                                           : absl::OkStatus();
}

absl::Status write_reports(const std::string& text, const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    absl::Status status = taken(file);
    if (is_free(file)) {
      status = write_file_atomically(file, std::as_bytes(std::span(text)));
    }
    if (!status.ok()) {
      return absl::Status(status.code(), absl::StrCat("the image is written, its report is not: ",
                                                      status.message()));
    }
  }
  return absl::OkStatus();
}

}  // namespace bandsaw::coordinator
