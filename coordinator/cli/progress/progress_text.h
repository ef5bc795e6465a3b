#pragma once

// Formats the state of a render as lines of text: UTF-8, without colours and line ends. The
// functions are pure.

#include <string>
#include <vector>

#include "coordinator/cli/progress/progress.h"

namespace bandsaw::coordinator {

/// Returns how many frames of a sequence are done: "12 of 48 frames · 2 failed".
std::string frames_done_text(const FrameCounts& frames);

/// Describes a job: "job 7 · cornell · 600×600 · until error ≤ 1 %". A render on this machine has
/// no job number; a sequence also has the number of its frames.
std::string header_line(const Progress& progress);

/// Returns a progress bar and figures: " 62 % ━━━━━━━━━━━━╸        error 1.6 % · 48 Msamples · 5.2
/// M/s · 0:09 left". The bar is shortened so that the line fits `width` columns. If the noise is
/// removed and the error of the clean image is known, the line states that error: "clean error
/// 1.6 %".
std::string bar_line(const Progress& progress, std::size_t width);

/// Returns the whole state in one line, for a pipe. The line has the figures of bar_line(), but no
/// bar. It also has the number of workers of a farm's job and, if the job waits, the reason.
std::string plain_line(const Progress& progress);

/// Returns a line for each worker: "   desk     16 threads  3.1 M/s   rows 320–352". If there are
/// more than `most` lines, the last one states how many workers are omitted. If the job waits, the
/// first line is the reason.
std::vector<std::string> worker_lines(const Progress& progress, std::size_t most);

/// Returns the result: "cornell.png · error 0.99 % · 21.4 s · 4 workers · report cornell.json".
/// The error is that of bar_line(). `name`: name of the image file or of the job. `reports`: names
/// of the report files; empty: none.
std::string final_line(const Progress& progress, const std::string& name,
                       const std::string& reports = {});

/// Returns cost and error distribution of the image: "256 samples a pixel · 8 M rays, 2 M/CPU s ·
/// 4.0 s of CPU · 1 % error after 11.6 s of CPU · error up to 1.2 % in half of the pixels, up to 5
/// % in 95 %". 11.6 s is the estimated CPU time at which the error of the image is 1 %.
std::string cost_line(const Progress& progress);

/// Returns a warning if few pixels have a large share of the error, because the error estimate may
/// then be too low. Returns an empty text if the estimate can be trusted.
std::string doubt_line(const Progress& progress);

/// Returns a warning about samples that were negative, infinite or NaN; empty if there are none.
std::string bad_samples_line(const Progress& progress);

/// Returns bad_samples_line() and doubt_line(), in this order. A text that is empty is left out.
std::vector<std::string> warning_lines(const Progress& progress);

/// Returns what is missing in the image: "0.2 % of the paths were cut off at depth 32 · 3
/// primitives without area left out"; empty if both counts are 0.
std::string left_out_line(const Progress& progress);

}  // namespace bandsaw::coordinator
