#pragma once

// What is said of an image beside it: how wrong it is, what it cost, and what it was made of. The
// fields and their units are documented in coordinator/README.md.

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/cli/progress/progress.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

struct Report {
  Progress progress;                 ///< of the finished job
  std::string pixels_sha256;         ///< empty: there is no whole image
  std::vector<std::string> outputs;  ///< the files of the image
  std::uint64_t cut_off_values = 0;  ///< of the image, in these files (output.h)
};

/// SHA-256 of the pixels as the farm sends them: linear RGB, float32, little-endian, rows from the
/// top; 64 hexadecimal digits.
std::string pixels_sha256(const Image& image);

/// What a report's bytes begin with, in every version of this program.
inline constexpr char kReportBegins[] = "{\n  \"schema\":\"bandsaw.report/";

/// The report as a file's text. What is not known is null.
std::string report_text(const Report& report);

}  // namespace bandsaw::coordinator
