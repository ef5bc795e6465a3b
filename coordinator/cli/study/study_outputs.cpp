// Checks and writes the files of `bandsaw study`: the data as CSV, the plot as SVG.

#include "coordinator/cli/study/study_outputs.h"

#include <span>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

bool is_plot(const std::string& output) { return absl::EndsWithIgnoreCase(output, ".svg"); }

}  // namespace

absl::Status check_study_outputs(const std::vector<std::string>& outputs) {
  for (const std::string& output : outputs) {
    if (!is_plot(output) && !absl::EndsWithIgnoreCase(output, ".csv")) {
      return absl::InvalidArgumentError(
          absl::StrCat("-o: must end in .csv or .svg, is '", output, "'"));
    }
  }
  return absl::OkStatus();
}

absl::Status check_study_writable(const std::vector<std::string>& outputs) {
  for (const std::string& output : outputs) {
    RETURN_IF_ERROR(check_can_be_written(output));
  }
  return absl::OkStatus();
}

absl::Status write_study(const std::vector<std::string>& outputs, const std::string& csv,
                         const Plot& plot) {
  for (const std::string& output : outputs) {
    const std::string text = is_plot(output) ? svg_of(plot) : csv;
    RETURN_IF_ERROR(write_file_atomically(output, std::as_bytes(std::span(text))));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw::coordinator
