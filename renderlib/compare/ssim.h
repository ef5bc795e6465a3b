#pragma once

// Structural similarity: Wang et al. 2004, "Image Quality Assessment: From Error Visibility to
// Structural Similarity", IEEE TIP 13(4), section III.

#include "renderlib/image/image.h"

namespace bandsaw {

/// Returns the mean SSIM over all pixels. It is computed from the sRGB-coded luminance in [0, 1],
/// with a Gaussian window of standard deviation 1.5 and radius 5. The result is 1 for equal images,
/// and at least -1 for any images. The images MUST have the same size.
double ssim(const Image& image, const Image& reference);

}  // namespace bandsaw
