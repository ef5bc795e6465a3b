#pragma once

// The two parts of an image's samples (DenoiseInput): makes them by further samples for an image
// that has no parts, and estimates from them the error of an image that another denoiser has
// cleaned (OpenImageDenoise, which the command line can use).

#include "renderlib/denoise/denoise.h"

namespace bandsaw {

/// Returns the mean of the second part of the samples. Pixels whose `first_share` is not in (0, 1)
/// have the value of `input.mean`.
Image second_part(const DenoiseInput& input);

/// Sets `mean`, `first`, `first_share` and `rendered_share` of `input`. `image` has `samples`
/// samples per pixel, which cannot be divided. `further` has `further_samples` samples per pixel,
/// which were rendered with another seed, so they are independent. All samples together are `mean`,
/// and the further samples are its first part. In a pixel that is not finite in both images, `mean`
/// is the pixel of `image`, and the share is 0, so that denoise() leaves it as it is.
void add_samples(const Image& image, double samples, Image further, double further_samples,
                 DenoiseInput& input);

/// Returns `clean` with an estimate of its error. `clean_first` and `clean_second` are the two
/// parts of the samples, each cleaned alone with the same guides (images of albedo, normal and
/// depth). Each of these two images depends only on its own part of the samples. So the squared
/// error of the mean of the two images can be estimated without bias, as for the filters of
/// denoise(), and the second estimate of common_bias() (squared_error.h) is used as there. A filter
/// that gets all samples at once has a smaller error, so the estimate is an upper bound. All images
/// have the size of `input.mean`.
Denoised with_error_of_halves(const DenoiseInput& input, Image clean, const Image& clean_first,
                              const Image& clean_second, Pool& pool);

}  // namespace bandsaw
