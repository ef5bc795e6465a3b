#pragma once

// The error of an image that another filter cleaned, estimated from the two parts of its samples.

#include "renderlib/denoise/denoise.h"

namespace bandsaw {

/// Returns the mean of the second part of the samples. Pixels whose share is not in (0, 1) are
/// those of `input.mean`.
Image second_part(const DenoiseInput& input);

/// Returns `clean` with its error, which is estimated from the two parts, each cleaned alone with
/// the same guides: the squared error of their mean is estimated without bias, as for the filters
/// of denoise(), because each depends on its part only. A filter that sees all samples at once does
/// better than that, so the error is an upper bound. All images have the size of `input.mean`.
Denoised with_error_of_halves(const DenoiseInput& input, Image clean, const Image& clean_first,
                              const Image& clean_second, Pool& pool);

}  // namespace bandsaw
