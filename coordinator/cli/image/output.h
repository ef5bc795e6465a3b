#pragma once

// Checks and writes the files that a user wants of an image (-o), for all commands that make
// images.

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"
#include "renderlib/image/layers.h"

namespace bandsaw::coordinator {

/// Checks that every output can be written. Commands call it before any work is done. The error
/// names the file.
absl::Status check_outputs_writable(const std::vector<std::string>& outputs);

/// Writes the image to every output, with its layers if the format supports them, each file
/// atomically. Tries all outputs and returns the first error.
absl::Status write_outputs(const Image& image, const std::vector<std::string>& outputs,
                           const Display& display, const Layers& layers = {});

/// Returns how many values of the image are clipped in an EXR file of 16-bit numbers (--half),
/// because 16-bit numbers cannot represent these values. Returns 0 if there is no such file among
/// the outputs.
std::uint64_t cut_off_values(const Image& image, const std::vector<std::string>& outputs,
                             const Display& display);

}  // namespace bandsaw::coordinator
