#pragma once

// What a study found, for people, for programs and as a picture. Pure functions.

#include <string>
#include <vector>

#include "coordinator/cli/study/log_plot.h"
#include "coordinator/cli/study/study_measure.h"

namespace bandsaw::coordinator {

/// Two tables in Markdown: what each technique is worth, and how the error falls. With a line end.
std::string study_table(const std::vector<StudyOfScene>& studies);

/// A line a point (RFC 4180), fractions and seconds, with a header.
std::string study_csv(const std::vector<StudyOfScene>& studies);

/// Error over CPU seconds, a panel a scene.
Plot study_plot(const std::vector<StudyOfScene>& studies);

}  // namespace bandsaw::coordinator
