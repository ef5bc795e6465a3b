#pragma once

// Writes image files. The data are written to a temporary file beside the target, fsynced and
// renamed, and the folder is fsynced: the target is either unchanged or complete.

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
  kPng,  ///< 8-bit sRGB codes (IEC 61966-2-1), clamped and rounded, after the display settings
  kPpm,  ///< binary PPM (P6) with the values of kPng
  kPfm,  ///< exact: 32-bit little-endian float, linear, rows from the bottom
  kHdr,  ///< Radiance RGBE (image/hdr.h), linear
  kExr,  ///< OpenEXR (image/exr.h), linear: exact floats, or halves
};

/// Returns the format that the suffix of a path names, in upper or lower case. For any other suffix
/// returns INVALID_ARGUMENT with a message that lists the supported suffixes.
absl::StatusOr<ImageFormat> image_format_of(const std::string& path);

/// Encodes the image. Layers are stored in EXR files only; other formats contain the image alone.
/// Returns INVALID_ARGUMENT if the image is empty, its number of pixels is wrong or a layer does
/// not fit it; RESOURCE_EXHAUSTED if it is too large for PNG or EXR.
absl::StatusOr<std::vector<std::byte>> encode_image(const Image& image, ImageFormat format,
                                                    const Display& display = {},
                                                    const Layers& layers = {});

/// Writes the image. Returns INVALID_ARGUMENT for an unknown suffix, the errors of encode_image(),
/// or the system's error: PERMISSION_DENIED, NOT_FOUND, RESOURCE_EXHAUSTED (disk full) …
absl::Status write_image(const Image& image, const std::string& path, const Display& display = {},
                         const Layers& layers = {});

/// Called before rendering. Returns OK if write_image() can begin: the suffix is known, and the
/// folder exists and is writable.
absl::Status check_writable(const std::string& path);

}  // namespace bandsaw
