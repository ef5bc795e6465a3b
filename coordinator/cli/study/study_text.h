#pragma once

// Formats the results of `bandsaw study` as tables, as CSV and as a plot. The functions are pure.

#include <string>
#include <vector>

#include "coordinator/cli/study/log_plot.h"
#include "coordinator/cli/study/study_measure.h"

namespace bandsaw::coordinator {

/// Returns two tables in Markdown. The first compares the methods at the largest number of samples.
/// The second shows for the first method how the error decreases with the number of samples. The
/// text ends with a line end.
std::string study_table(const std::vector<StudyOfScene>& studies);

/// Returns a header and a line for each point (CSV of RFC 4180). Errors are fractions; times are
/// seconds.
std::string study_csv(const std::vector<StudyOfScene>& studies);

/// Returns a plot of the error against CPU seconds, one panel per scene.
Plot study_plot(const std::vector<StudyOfScene>& studies);

}  // namespace bandsaw::coordinator
