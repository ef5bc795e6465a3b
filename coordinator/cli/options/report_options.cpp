#include "coordinator/cli/options/report_options.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"

namespace bandsaw::coordinator {

void add_report(CLI::App& app, RawOptions& raw) {
  app.add_option("--report", raw.report,
                 "File for the report of error and cost (.json), or none "
                 "[default: beside each image, with its name]")
      ->type_name("FILE|none");
}

absl::StatusOr<ReportOption> checked_report(const RawOptions& raw, bool has_images) {
  if (!raw.report) {
    return ReportOption();
  }
  if (!has_images) {
    return absl::InvalidArgumentError("--report is written with the image: add -o FILE");
  }
  if (*raw.report != "none" && !absl::EndsWithIgnoreCase(*raw.report, ".json")) {
    return absl::InvalidArgumentError(
        absl::StrCat("--report: must end in .json, or be none, is '", *raw.report, "'"));
  }
  return ReportOption{*raw.report};
}

}  // namespace bandsaw::coordinator
