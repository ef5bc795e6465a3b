#pragma once

// Pictures to files. Written to a temporary file beside the target, fsynced, renamed, folder
// fsynced: the target is either as it was or whole.

#include <cstddef>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "renderlib/image/display.h"
#include "renderlib/image/image.h"
#include "renderlib/image/layers.h"

namespace bandsaw {

enum class ImageFormat {
  kPng,  ///< 8-bit, as display says, sRGB (IEC 61966-2-1), clamped, round(255 x)
  kPpm,  ///< the same numbers, P6
  kPfm,  ///< exact: 32-bit float little-endian, linear, rows from the bottom
  kHdr,  ///< Radiance RGBE (image/hdr.h), linear
  kExr,  ///< OpenEXR (image/exr.h), linear: exact floats, or halves
};

/// By the suffix, any case. INVALID_ARGUMENT naming the suffixes that are known.
absl::StatusOr<ImageFormat> image_format_of(const std::string& path);

/// Layers go into EXR files; the other formats hold the image alone.
absl::StatusOr<std::vector<std::byte>> encode_image(const Image& image, ImageFormat format,
                                                    const Display& display = {},
                                                    const Layers& layers = {});

/// INVALID_ARGUMENT: suffix. Otherwise the system's reason: PERMISSION_DENIED, NOT_FOUND,
/// RESOURCE_EXHAUSTED (disk full) …
absl::Status write_image(const Image& image, const std::string& path, const Display& display = {},
                         const Layers& layers = {});

/// Whether write_image would be able to begin: the suffix is known, the folder exists and can be
/// written. Before any rendering.
absl::Status check_writable(const std::string& path);

}  // namespace bandsaw
