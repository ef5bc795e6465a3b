#pragma once

// The report of an image is a JSON file beside the image. The report states the image's error, cost
// and inputs. coordinator/README.md documents the fields and their units.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/cli/progress/progress.h"
#include "renderlib/denoise/denoise.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// The input of report_text().
struct Report {
  Progress progress;                 ///< status of the finished job, or of a render on this machine
  std::string pixels_sha256;         ///< digest of the image; empty: the image is incomplete
  std::vector<std::string> outputs;  ///< files of the image
  std::uint64_t cut_off_values = 0;  ///< number of values clipped in these files (output.h)
  /// About the image without noise; std::nullopt: the noise was not removed.
  struct Clean {
    CleanError error;
    std::string method;                    ///< "regression" or "oidn"
    bool same_bits = true;                 ///< false: another machine may give other bits
    std::string pixels_sha256;             ///< digest of the clean image
    std::vector<std::string> raw_outputs;  ///< files of the image as rendered
  };
  std::optional<Clean> clean = std::nullopt;
};

/// Returns the SHA-256 of the pixels in the form in which the farm sends them: linear RGB, float32,
/// little-endian, rows from the top; 64 hexadecimal digits.
std::string pixels_sha256(const Image& image);

/// The first bytes of a report, in every version of this program. Files are recognised by them.
inline constexpr char kReportBegins[] = "{\n  \"schema\":\"bandsaw.report/";

/// Returns the text of the report file, a JSON object. Unknown values are null.
std::string report_text(const Report& report);

}  // namespace bandsaw::coordinator
