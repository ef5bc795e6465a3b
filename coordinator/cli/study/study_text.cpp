// Formats the results of `bandsaw study` as Markdown tables, as CSV and as a plot.

#include "coordinator/cli/study/study_text.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "coordinator/cli/base/text.h"

namespace bandsaw::coordinator {
namespace {

/// Returns how the error falls with the number n of samples, such as "n^-0.52".
std::string fall_text(const StudyLine& line) {
  const auto slope = slope_of(line);
  return slope ? absl::StrFormat("n^%.2f", *slope) : "–";
}

std::string bias_text(const StudyPoint& point) {
  return absl::StrFormat("%+.2f ± %.2f %%", 100 * point.bias, 100 * point.bias_error);
}

std::string percent_text(double fraction) { return absl::StrFormat("%.3g %%", 100 * fraction); }

/// Replaces each '|' by '/', because a '|' would end the cell of the table.
std::string cell(const std::string& name) { return absl::StrReplaceAll(name, {{"|", "/"}}); }

/// Returns the row of the first table for one method. The row has the results of the method at its
/// largest number of samples, and its CPU time to 1 % error. In brackets it has this time divided
/// by that of the first method.
std::string method_row(const StudyOfScene& study, const StudyLine& line) {
  const StudyPoint& last = line.points.back();
  const auto needed = cpu_s_to_1_percent(line);
  const auto needed_by_first = cpu_s_to_1_percent(study.lines.front());
  std::string to_target = needed ? duration(*needed) : "–";
  if (needed && needed_by_first && *needed_by_first > 0) {
    absl::StrAppendFormat(&to_target, " (%.2g ×)", *needed / *needed_by_first);
  }
  return absl::StrFormat("| %s | %s | %.4g | %s | %s | %s | %.2f | %.1f | %s |\n",
                         cell(study.scene), method_name(line.method), last.samples,
                         percent_text(last.relative_rmse), bias_text(last), fall_text(line),
                         last.cpu_s, last.cpu_s > 0 ? last.rays / last.cpu_s / 1e6 : 0, to_target);
}

/// Returns the text as a field of CSV in quotes.
std::string quoted(const std::string& text) {
  return absl::StrCat("\"", absl::StrReplaceAll(text, {{"\"", "\"\""}}), "\"");
}

}  // namespace

std::string study_table(const std::vector<StudyOfScene>& studies) {
  std::string out =
      "| scene | technique | samples a pixel | error (relRMSE) | bias of the mean | falls as | CPU "
      "s "
      "| Mrays / CPU s | CPU time to 1 % |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const StudyOfScene& study : studies) {
    for (const StudyLine& line : study.lines) {
      absl::StrAppend(&out, method_row(study, line));
    }
  }
  absl::StrAppend(
      &out,
      "\n| scene | samples a pixel | error (relRMSE) | relMSE | CPU s | reference's own "
      "error |\n| --- | --- | --- | --- | --- | --- |\n");
  for (const StudyOfScene& study : studies) {
    for (const StudyPoint& point : study.lines.front().points) {
      absl::StrAppendFormat(&out, "| %s | %.4g | %s | %.2g | %.2g | %s |\n", cell(study.scene),
                            point.samples, percent_text(point.relative_rmse), point.relative_mse,
                            point.cpu_s, percent_text(study.reference_error));
    }
  }
  return out;
}

std::string study_csv(const std::vector<StudyOfScene>& studies) {
  std::string out =
      "scene,technique,samples_per_pixel,relative_rmse,relative_mse,bias,bias_standard_error,cpu_s,"
      "rays,reference_relative_rmse\n";
  for (const StudyOfScene& study : studies) {
    for (const StudyLine& line : study.lines) {
      for (const StudyPoint& point : line.points) {
        absl::StrAppendFormat(&out, "%s,%s,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n",
                              quoted(study.scene), quoted(method_name(line.method)), point.samples,
                              point.relative_rmse, point.relative_mse, point.bias, point.bias_error,
                              point.cpu_s, point.rays, study.reference_error);
      }
    }
  }
  return out;
}

Plot study_plot(const std::vector<StudyOfScene>& studies) {
  Plot plot{.x = "CPU seconds an image", .y = "error (relative RMSE)", .panels = {}};
  for (const StudyOfScene& study : studies) {
    PlotPanel panel{.title = study.scene, .lines = {}};
    for (const StudyLine& line : study.lines) {
      PlotLine drawn{.name = method_name(line.method), .note = fall_text(line), .points = {}};
      for (const StudyPoint& point : line.points) {
        drawn.points.emplace_back(point.cpu_s, point.relative_rmse);
      }
      panel.lines.push_back(std::move(drawn));
    }
    plot.panels.push_back(std::move(panel));
  }
  return plot;
}

}  // namespace bandsaw::coordinator
