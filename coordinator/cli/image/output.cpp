// Checks and writes all output files of one image. If a file cannot be written, the other files are
// still written.

#include "coordinator/cli/image/output.h"

#include <algorithm>

#include "absl/strings/match.h"
#include "coordinator/cli/options/output_names.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/exr.h"
#include "renderlib/image/write_image.h"

namespace bandsaw::coordinator {

absl::Status check_outputs_writable(const std::vector<std::string>& outputs) {
  for (const std::string& output : outputs) {
    // A part of an image (.band) is no picture, so check_writable() does not know its suffix.
    RETURN_IF_ERROR(is_part_name(output) ? check_can_be_written(output) : check_writable(output));
  }
  return absl::OkStatus();
}

absl::Status write_outputs(const Image& image, const std::vector<std::string>& outputs,
                           const Display& display, const Layers& layers) {
  absl::Status first;
  for (const std::string& output : outputs) {
    first.Update(write_image(image, output, display, layers));
  }
  return first;
}

std::uint64_t cut_off_values(const Image& image, const std::vector<std::string>& outputs,
                             const Display& display) {
  const auto is_exr = [](const std::string& output) {
    return absl::EndsWithIgnoreCase(output, ".exr");
  };
  return display.half && std::any_of(outputs.begin(), outputs.end(), is_exr) ? beyond_half(image)
                                                                             : 0;
}

}  // namespace bandsaw::coordinator
