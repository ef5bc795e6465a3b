#pragma once

// From images to the planes that are fitted.

#include "renderlib/denoise/denoise.h"
#include "renderlib/denoise/maps.h"

namespace bandsaw {

/// Means over the whole image.
struct ImageMeans {
  float brightness = 0;  ///< mean value of the channels of all pixels whose values may be used
  float depth = 1;       ///< of the pixels that show a surface
};
ImageMeans means_of(const DenoiseInput& input);

/// Distance of the farthest row on which a clean pixel depends.
inline constexpr int kDenoiseReach = 24;

/// Returns the planes of some rows of the image, whose first is even. In each half, a pixel that is
/// brighter than all pixels up to two away in the other half is scaled down to the brightest of
/// them: a single bright path, which a filter would spread over the pixels around. The rows at the
/// ends are not as in the whole image, up to 5 of them: they lack neighbours.
FitInput prepare_fit(const DenoiseInput& input, const ImageMeans& means, const RowSpan& rows,
                     Pool& pool);

/// Returns the value of the second part of a pixel's samples, for one channel.
inline float second_value(float mean, float first, float first_share) {
  return (mean - first_share * first) / (1 - first_share);
}

}  // namespace bandsaw
