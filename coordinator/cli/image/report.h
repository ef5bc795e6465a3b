#pragma once

// The report of an image: its error, its cost, and its inputs. The fields and their units are
// documented in coordinator/README.md.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/cli/progress/progress.h"
#include "renderlib/denoise/denoise.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

struct Report {
  Progress progress;                 ///< status of the finished job
  std::string pixels_sha256;         ///< empty: the image is incomplete
  std::vector<std::string> outputs;  ///< files of the image
  std::uint64_t cut_off_values = 0;  ///< values clipped in these files (output.h)
  /// The error of the clean image; absent if the image was not cleaned.
  struct Clean {
    CleanError error;
    std::string method;     ///< "regression" or "oidn"
    bool same_bits = true;  ///< false: another machine may give other bits
    std::string pixels_sha256;
    std::vector<std::string> raw_outputs;  ///< files of the image as rendered
  };
  std::optional<Clean> clean = std::nullopt;
};

/// Returns the SHA-256 of the pixels in the form in which the farm sends them: linear RGB, float32,
/// little-endian, rows from the top; 64 hexadecimal digits.
std::string pixels_sha256(const Image& image);

/// The first bytes of a report, in every version of this program.
inline constexpr char kReportBegins[] = "{\n  \"schema\":\"bandsaw.report/";

/// Returns the content of the report file. Unknown values are null.
std::string report_text(const Report& report);

}  // namespace bandsaw::coordinator
