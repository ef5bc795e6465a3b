#pragma once

// The files that an image goes to.

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"
#include "renderlib/image/layers.h"

namespace bandsaw::coordinator {

/// Whether the name ends in .band (any case): the sums of some rows rather than a picture.
bool is_part_name(const std::string& path);

/// "scenes/cornell.textproto", ".png" -> "cornell.png": the file's stem, in the current folder.
std::string default_output(const std::string& scene, const std::string& suffix);

/// Whether every output can be written, before any work. The error names the file.
absl::Status check_outputs_writable(const std::vector<std::string>& outputs);

/// Writes the image, and its layers where the format has room for them, to every output, each whole
/// or not at all; stops at the first error.
absl::Status write_outputs(const Image& image, const std::vector<std::string>& outputs,
                           const Display& display, const Layers& layers = {});

/// Numbers of the image that were cut off since an EXR file of halves has no room for them; 0 where
/// no such file is among the outputs.
std::uint64_t cut_off_values(const Image& image, const std::vector<std::string>& outputs,
                             const Display& display);

/// "cornell.png, cornell.pfm", fit for a terminal.
std::string names_of(const std::vector<std::string>& outputs);

}  // namespace bandsaw::coordinator
