#pragma once

// Estimates the error of an image that another denoiser has cleaned (OpenImageDenoise, which the
// command line can use), from two parts of its samples.

#include "renderlib/denoise/denoise.h"

namespace bandsaw {

/// Returns the mean of the second part of the samples. Pixels whose `first_share` is not in (0, 1)
/// have the value of `input.mean`.
Image second_part(const DenoiseInput& input);

/// Returns `clean` with an estimate of its error. `clean_first` and `clean_second` are the two
/// parts of the samples, each cleaned alone with the same guides (images of albedo, normal and
/// depth). Each of these two images depends only on its own part of the samples. So the squared
/// error of the mean of the two images can be estimated without bias, as for the filters of
/// denoise(). A filter that gets all samples at once has a smaller error, so the estimate is an
/// upper bound. All images have the size of `input.mean`.
Denoised with_error_of_halves(const DenoiseInput& input, Image clean, const Image& clean_first,
                              const Image& clean_second, Pool& pool);

}  // namespace bandsaw
