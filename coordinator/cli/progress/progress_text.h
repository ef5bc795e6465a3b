#pragma once

// Progress as lines of text, UTF-8, without colours and without line ends. Pure functions.

#include <string>
#include <vector>

#include "coordinator/cli/progress/progress.h"

namespace bandsaw::coordinator {

/// "job 7 · cornell · 600×600 · until error ≤ 1 %"; a local render has no job.
std::string header_line(const Progress& progress);

/// " 62 % ━━━━━━━━━━━━╸        error 1.6 % · 48 Msamples · 5.2 M/s · 0:09 left"; the bar is
/// shorter where `width` columns have no room for all of it.
std::string bar_line(const Progress& progress, std::size_t width);

/// The same without the bar, with the number of workers and what the job waits for: one line says
/// all, for a pipe.
std::string plain_line(const Progress& progress);

/// "   desk     16 threads  3.1 M/s   rows 320–352": at most `most` lines, the last of them says
/// how many more there are. What the job waits for comes first, when it waits.
std::vector<std::string> worker_lines(const Progress& progress, std::size_t most);

/// "cornell.png · error 0.99 % · 21.4 s · 4 workers · report cornell.json". `name`: of the image,
/// or of the job; `reports`: their names, or empty.
std::string final_line(const Progress& progress, const std::string& name,
                       const std::string& reports = {});

/// "256 samples a pixel · 8 M rays, 2 M/CPU s · 4.0 s of CPU · 1 % after 11.6 s of CPU · half of
/// the pixels within 1.2 %, 95 % within 5 %": what the image cost and where its error lies.
std::string cost_line(const Progress& progress);

/// What must not be overlooked about the error; empty when it can be trusted.
std::string doubt_line(const Progress& progress);

/// What must not be overlooked about samples that were not numbers; empty when all were.
std::string bad_samples_line(const Progress& progress);

/// Those of the two that are not empty.
std::vector<std::string> warning_lines(const Progress& progress);

/// "0.2 % of the paths were cut off at depth 32 · 3 primitives without area left out"; empty when
/// neither is so.
std::string left_out_line(const Progress& progress);

}  // namespace bandsaw::coordinator
