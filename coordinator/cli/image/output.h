#pragma once

// Writes the files of an image.

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"
#include "renderlib/image/layers.h"

namespace bandsaw::coordinator {

/// Checks that every output can be written, before any work is done. The error names the file.
absl::Status check_outputs_writable(const std::vector<std::string>& outputs);

/// Writes the image to every output, with its layers if the format supports them, each file
/// atomically. Tries all outputs and returns the first error.
absl::Status write_outputs(const Image& image, const std::vector<std::string>& outputs,
                           const Display& display, const Layers& layers = {});

/// Returns the number of values that were clipped because an EXR file with half-precision numbers
/// cannot represent them; 0 if there is no such file among the outputs.
std::uint64_t cut_off_values(const Image& image, const std::vector<std::string>& outputs,
                             const Display& display);

}  // namespace bandsaw::coordinator
