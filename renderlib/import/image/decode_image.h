#pragma once

// Image files to texels, by stb_image and, for the formats that it does not know, libwebp and
// tinyexr.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/image/image.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Largest image file that is read.
inline constexpr std::uint64_t kMaxImageFileBytes = std::uint64_t{2} << 30;

/// The warning about an image with an alpha channel.
inline constexpr char kAlphaWarning[] = "its alpha channel is left out";

/// What becomes of an image of one channel.
enum class Gray { kExpanded, kKept };

/// PNG, JPEG, TGA, BMP, PNM, WebP: 8-bit sRGB of three channels (or one: `gray`), alpha and a
/// second byte of depth left out with a warning. HDR, EXR: linear floats. The texels are what the
/// decoder made, uncopied. Sizes are checked before anything is decoded. INVALID_ARGUMENT: the
/// reason, without the file's name.
absl::StatusOr<ImageTexture> decode_image(absl::string_view bytes,
                                          std::vector<std::string>& warnings,
                                          Gray gray = Gray::kExpanded);

/// The alpha of an 8-bit image as a linear one of one channel; all 255 where it has none.
absl::StatusOr<ImageTexture> decode_alpha(absl::string_view bytes);

/// Whether the file has an alpha channel; not of one that cannot be read.
bool image_has_alpha(absl::string_view bytes);

/// The same as a linear picture; PFM too.
absl::StatusOr<Image> decode_picture(absl::string_view bytes);

}  // namespace bandsaw
