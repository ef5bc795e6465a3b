#pragma once

// Decodes image files with stb_image and, for formats that it does not support, libwebp and
// tinyexr.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/image/image.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Image files of this size or more are refused, because stb_image takes the size as an int.
inline constexpr std::uint64_t kMaxImageFileBytes = std::uint64_t{2} << 30;

/// Warning about an image with an alpha channel.
inline constexpr char kAlphaWarning[] = "its alpha channel is left out";

/// The channels of a decoded grey image: three equal ones, or a single one.
enum class Gray { kExpanded, kKept };

/// Decodes an image file. PNG, JPEG, TGA, BMP, PNM and WebP become 8-bit sRGB with three channels
/// (or one, if the file is grey and `gray` is kKept); alpha and the second byte of channels with 16
/// bits are omitted with a warning. A PNM file with 16 bits for each value is an error. HDR and EXR
/// become linear floats. Except for EXR, the texels stay in the decoder's memory and are not
/// copied. Sizes are checked before anything is decoded. Returns INVALID_ARGUMENT, or
/// RESOURCE_EXHAUSTED for a file of 2 GiB or more. The message gives the reason but not the file's
/// name.
absl::StatusOr<ImageTexture> decode_image(absl::string_view bytes,
                                          std::vector<std::string>& warnings,
                                          Gray gray = Gray::kExpanded);

/// Decodes the alpha of an image as a linear 8-bit image of one channel. If the image has no alpha,
/// the result is a single texel of 255. Returns INVALID_ARGUMENT for an EXR file, and the errors of
/// decode_image().
absl::StatusOr<ImageTexture> decode_alpha(absl::string_view bytes);

/// Returns true if the file has an alpha channel; false for EXR and if the file cannot be read.
bool image_has_alpha(absl::string_view bytes);

/// Decodes an image file, PFM included, to linear floats without alpha, for `bandsaw compare` and
/// for light maps that a converter resamples. Returns the errors of decode_image().
absl::StatusOr<Image> decode_picture(absl::string_view bytes);

}  // namespace bandsaw
