#pragma once

// Formats the results of a study as tables, CSV and plot. Pure functions.

#include <string>
#include <vector>

#include "coordinator/cli/study/log_plot.h"
#include "coordinator/cli/study/study_measure.h"

namespace bandsaw::coordinator {

/// Returns two tables in Markdown: the benefit of each technique, and the decrease of the error.
/// Ends with a line end.
std::string study_table(const std::vector<StudyOfScene>& studies);

/// Returns one line per point (RFC 4180), fractions and seconds, with a header.
std::string study_csv(const std::vector<StudyOfScene>& studies);

/// Returns a plot of the error against CPU seconds, one panel per scene.
Plot study_plot(const std::vector<StudyOfScene>& studies);

}  // namespace bandsaw::coordinator
